// A model in time: welded surface, rest pose, and the pose of every frame (see animation.h).
#include "scene/animation.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "config/suggest.h"
#include "io/import.h"
#include "mesh/frames.h"
#include "mesh/weld.h"
#include "scene/instances.h"
#include "scene/rig.h"

namespace plisse::scene {
namespace {

bool finite(double value) {
  return std::isfinite(value);
}
bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
bool finite(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  return true;
}

// The first clip that lasts: poses that programs save as clips of no length are passed over, where others
// follow.
int first_clip(const io::Model& model) {
  if (model.clips.empty()) return -1;
  for (std::size_t c = 0; c < model.clips.size(); ++c) {
    if (!(model.clips[c].duration > 0)) continue;
    if (c > 0)
      log::warn_once(
          "clip " + model.path.string(),
          fmt::format("{}: clip '{}' has no length and is passed over; '{}' is played (--clip chooses)",
                      model.path.string(), model.clips[0].name, model.clips[c].name));
    return static_cast<int>(c);
  }
  return 0;
}

// Index of the clip of this name or number, −1 where there is none.
int find_clip(const io::Model& model, const std::string& choice) {
  const auto named = std::find_if(model.clips.begin(), model.clips.end(),
                                  [&](const io::Clip& clip) { return clip.name == choice; });
  if (named != model.clips.end()) return static_cast<int>(named - model.clips.begin());
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  if (error == std::errc{} && end == choice.data() + choice.size() && index < model.clips.size())
    return static_cast<int>(index);
  return -1;
}

// Index of the chosen clip, −1 where the model has none and none was asked for.
int choose_clip(const io::Model& model, const std::string& choice) {
  if (choice.empty()) return first_clip(model);
  if (const int found = find_clip(model, choice); found >= 0) return found;
  std::vector<std::string> names;
  for (const io::Clip& clip : model.clips) names.push_back(clip.name);
  if (names.empty())
    throw Error(ExitCode::bad_input, fmt::format("{}: clip '{}' asked for, but the model has no clips",
                                                 model.path.string(), choice));
  std::vector<std::string> listed;
  for (std::size_t i = 0; i < names.size(); ++i) listed.push_back(fmt::format("{} '{}'", i, names[i]));
  throw Error(ExitCode::bad_input,
              fmt::format("{}: no clip '{}'{}; it has, by index or name: {}", model.path.string(), choice,
                          config::did_you_mean(choice, names), fmt::join(listed, ", ")));
}

// Takes the track that `from` has over to `to`; true where both have it.
template <typename Value>
bool take(io::Keys<Value>& to, const io::Keys<Value>& from) {
  if (from.times.empty()) return false;
  if (!to.times.empty()) return true;
  to = from;
  return false;
}

// Clips played together, from the same beginning: actions of several objects. Where two of them move the same
// part of a node, the first counts.
io::Clip together(const io::Model& model, const std::vector<int>& clips) {
  io::Clip result;
  std::set<std::string> given_way;
  for (const int c : clips) {
    const io::Clip& clip = model.clips[static_cast<std::size_t>(c)];
    result.name += (result.name.empty() ? "" : ",") + clip.name;
    result.duration = std::max(result.duration, clip.duration);
    for (const io::Channel& channel : clip.channels) {
      auto known = std::find_if(result.channels.begin(), result.channels.end(),
                                [&](const io::Channel& one) { return one.node == channel.node; });
      if (known == result.channels.end()) {
        result.channels.push_back(channel);
        continue;
      }
      bool both = take(known->translation, channel.translation);
      both |= take(known->rotation, channel.rotation);
      both |= take(known->scale, channel.scale);
      both |= take(known->morph_weights, channel.morph_weights);
      if (both) given_way.insert(clip.name);
    }
  }
  if (!given_way.empty())
    log::warn(fmt::format("{}: clips that move the same nodes as one before them: '{}'; the first counts",
                          model.path.string(), fmt::join(given_way, "', '")));
  return result;
}

// The clip that is played; nothing where the model has none and none was asked for. "all", or several names
// or numbers with commas between: together.
std::optional<io::Clip> chosen_clip(const io::Model& model, const std::string& choice) {
  std::vector<int> clips;
  if (find_clip(model, choice) < 0 && !model.clips.empty()) {
    if (choice == "all") {
      for (std::size_t c = 0; c < model.clips.size(); ++c) clips.push_back(static_cast<int>(c));
    } else if (choice.find(',') != std::string::npos) {
      for (std::size_t at = 0; at <= choice.size();) {
        const std::size_t end = std::min(choice.find(',', at), choice.size());
        const std::string name(trimmed(std::string_view(choice).substr(at, end - at)));
        if (name.empty())
          throw Error(ExitCode::bad_input,
                      fmt::format("{}: clips '{}' asked for, with no name between commas",
                                  model.path.string(), choice));
        const int clip = choose_clip(model, name);
        if (std::find(clips.begin(), clips.end(), clip) == clips.end()) clips.push_back(clip);
        at = end + 1;
      }
    }
  }
  if (!clips.empty()) return together(model, clips);
  const int clip = choose_clip(model, choice);
  if (clip < 0) return std::nullopt;
  return model.clips[static_cast<std::size_t>(clip)];
}

// contract.md, "Frames, time, units"; the 1e-3 allows for the rounding of durations in single precision.
constexpr double time_rounding = 1e-3;  // of a frame
int frames_of(const io::Model& model, const std::string& what, const Timeline& timeline) {
  const double frames = std::floor(timeline.duration * timeline.frames_per_second + time_rounding) + 1;
  if (!(frames < 1e9))
    throw Error(ExitCode::bad_input, fmt::format("{}: {} of {} s has more frames than can be counted",
                                                 model.path.string(), what, timeline.duration));
  return static_cast<int>(frames);
}

Timeline timeline_of(const io::Model& model, const io::Clip* clip, double frames_per_second) {
  Timeline timeline;
  if (!model.cache.empty()) {
    timeline.frames_per_second = frames_per_second > 0 ? frames_per_second : model.cache.frames_per_second();
    if (const std::vector<double>& times = model.cache.times(); !times.empty()) {
      timeline.duration = times.back();
      timeline.frame_count = frames_of(model, "the point cache", timeline);
      return timeline;
    }
    timeline.frame_count = static_cast<int>(model.cache.size());
    timeline.duration = (timeline.frame_count - 1) / timeline.frames_per_second;
    return timeline;
  }
  if (frames_per_second > 0) timeline.frames_per_second = frames_per_second;
  if (clip == nullptr) return timeline;
  timeline.duration = clip->duration;
  timeline.frame_count = frames_of(model, fmt::format("clip '{}'", clip->name), timeline);
  return timeline;
}

// Render vertices of one welded vertex that share everything are one: uvs, file normal, colour, by bits.
struct RenderKey {
  std::array<std::uint64_t, 8> bits{};
  bool operator==(const RenderKey&) const = default;
};
struct RenderKeyHash {
  std::size_t operator()(const RenderKey& key) const {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : key.bits)
      hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL, hash ^= hash >> 31;
    return static_cast<std::size_t>(hash);
  }
};

RenderKey render_key(const Instances& from, std::uint32_t v, std::uint32_t welded) {
  const auto two = [](float a, float b) {
    return std::uint64_t{std::bit_cast<std::uint32_t>(a)} << 32 | std::bit_cast<std::uint32_t>(b);
  };
  const glm::dvec3 n = from.normals[v];
  const glm::vec2 uv = from.uvs[v], normal_uv = from.normal_uvs[v];
  const glm::vec4 colour = from.colours[v];
  return {{welded, two(uv.x, uv.y), std::bit_cast<std::uint64_t>(n.x), std::bit_cast<std::uint64_t>(n.y),
           std::bit_cast<std::uint64_t>(n.z), two(normal_uv.x, normal_uv.y), two(colour.r, colour.g),
           two(colour.b, colour.a)}};
}

// Render vertices in the order of their welded ones, the first of each before all that seams add: files that
// have one kind of vertex only begin with the model's vertices in their order.
void order_render_vertices(Surface& surface, std::vector<glm::dvec3>& normals) {
  std::vector<bool> met(surface.vertex_count(), false), added;
  for (const RenderVertex& vertex : surface.render_vertices) {
    added.push_back(met[vertex.welded]);
    met[vertex.welded] = true;
  }
  std::vector<std::uint32_t> order(added.size()), place(added.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(bool(added[a]), surface.render_vertices[a].welded) <
           std::pair(bool(added[b]), surface.render_vertices[b].welded);
  });
  std::vector<RenderVertex> vertices;
  std::vector<glm::dvec3> arranged;
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    vertices.push_back(surface.render_vertices[order[i]]);
    arranged.push_back(normals[order[i]]);
    place[order[i]] = i;
  }
  surface.render_vertices = std::move(vertices);
  normals = std::move(arranged);
  for (std::uint32_t& corner : surface.triangles) corner = place[corner];
}

// Surface with everything but `rest` (which is set to `bind`); `normals` gets each render vertex's file
// normal in the space of bind, 0 where there is none.
Surface build_surface(const Instances& from, const Weld& weld, std::vector<glm::dvec3>& normals) {
  Surface surface;
  const std::size_t welded = weld.representative.size();
  surface.bind.reserve(welded);
  surface.influences.reserve(welded);
  for (const std::uint32_t v : weld.representative) {
    surface.bind.push_back(from.vertices.positions[v]);
    surface.influences.push_back(from.vertices.influences[v]);
  }
  surface.rest = surface.bind;
  surface.target_count = from.targets.size();
  surface.target_deltas.reserve(from.targets.size() * welded);
  for (std::size_t t = 0; t < from.targets.size(); ++t)
    for (const std::uint32_t v : weld.representative)
      surface.target_deltas.push_back(from.vertices.target_deltas[t * from.vertices.positions.size() + v]);

  // The new vertex of each vertex of the file is stored for its other corners.
  constexpr std::uint32_t none = 0xFFFFFFFF;
  std::vector<std::uint32_t> become(from.vertices.positions.size(), none);
  std::unordered_map<RenderKey, std::uint32_t, RenderKeyHash> known;
  known.reserve(become.size());
  surface.triangles.reserve(from.triangles.size());
  for (const std::uint32_t v : from.triangles) {
    if (become[v] == none) {
      const std::uint32_t id = weld.welded[v];
      const auto [entry, fresh] = known.try_emplace(
          render_key(from, v, id), static_cast<std::uint32_t>(surface.render_vertices.size()));
      if (fresh) {
        surface.render_vertices.push_back({id, from.uvs[v], {0, 1, 0}, from.normal_uvs[v], from.colours[v]});
        normals.push_back(from.normals[v]);
      }
      become[v] = entry->second;
    }
    surface.triangles.push_back(become[v]);
  }
  order_render_vertices(surface, normals);
  surface.parts = from.parts;
  build_adjacency(surface);

  // Where areas cancel (a sheet modelled twice, back to back) the file's normals are used, or else those of
  // any triangle.
  std::vector<glm::dvec3> file_normal(welded, glm::dvec3{0});
  for (std::size_t r = 0; r < normals.size(); ++r)
    file_normal[surface.render_vertices[r].welded] += normals[r];
  surface.bind_normal.reserve(welded);
  for (std::size_t v = 0; v < welded; ++v) {
    glm::dvec3 fallback = file_normal[v];
    for (std::uint32_t c = surface.corners.offsets[v];
         c < surface.corners.offsets[v + 1] && glm::length(fallback) < 1e-3; ++c) {
      const Corner& corner = surface.corners.items[c];
      const glm::dvec3 area = glm::cross(surface.bind[corner.second] - surface.bind[v],
                                         surface.bind[corner.third] - surface.bind[v]);
      if (glm::length(area) > 0) fallback = glm::normalize(area);
    }
    fallback = glm::length(fallback) > 0 ? glm::normalize(fallback) : glm::dvec3{0, 1, 0};
    surface.bind_normal.push_back(area_normal(surface, surface.bind, v, fallback));
  }
  return surface;
}

// The file's normals belong to the bind pose. They are transferred to the rest pose as components in the
// tangent frames (docs/passes.md, "Skin"); where the file has none, the surface's own normals are used.
void set_render_normals(Surface& surface, const std::vector<glm::dvec3>& normals) {
  const RestFrames rest = rest_frames(surface);
  const bool bound = surface.rest == surface.bind;
  for (std::size_t r = 0; r < normals.size(); ++r) {
    RenderVertex& vertex = surface.render_vertices[r];
    const std::size_t v = vertex.welded;
    glm::dvec3 normal = rest.normal[v];
    if (glm::dot(normals[r], normals[r]) > 0) {
      const glm::dvec3 n = surface.bind_normal[v];
      const glm::dvec3 t = tangent_along(surface.bind[rest.tangent_neighbour[v]] - surface.bind[v], n);
      const glm::dvec3 b = glm::cross(n, t);
      normal = bound ? normals[r]
                     : glm::dot(normals[r], t) * rest.tangent[v] +
                           glm::dot(normals[r], b) * glm::cross(rest.normal[v], rest.tangent[v]) +
                           glm::dot(normals[r], n) * rest.normal[v];
    }
    vertex.normal = glm::vec3(glm::normalize(normal));
  }
}

}  // namespace

struct Animation::Data {
  Data(const io::Model& model, const AnimationChoice& choice, const io::Clip* clip)
      : rig(model, clip),
        timeline(timeline_of(model, clip, choice.frames_per_second)),
        path(model.path.string()) {
    if (clip != nullptr) clip_name = clip->name;
  }

  Pose evaluate(int frame) const {
    Pose pose;
    if (!cache.empty()) {
      pose.palette.assign(1, glm::dmat4{1});
      const auto [before, part] = place_in_cache(frame);
      const io::VertexCache::Frame positions = cache.frame(before);
      pose.cache.reserve(cache_index.size());
      for (const std::uint32_t v : cache_index) pose.cache.push_back((*positions)[v]);
      if (part == 0) return pose;
      const io::VertexCache::Frame next = cache.frame(before + 1);
      for (std::size_t i = 0; i < cache_index.size(); ++i)
        pose.cache[i] = glm::mix(pose.cache[i], (*next)[cache_index[i]], part);
      return pose;
    }
    const double time = timeline.time(frame);
    const std::vector<glm::dmat4> world = rig.world(time);
    pose.palette.reserve(palette.size());
    for (const PaletteEntry& entry : palette)
      pose.palette.push_back(entry.node < 0 ? entry.right
                                            : world[static_cast<std::size_t>(entry.node)] * entry.right);
    int node = -1;
    std::vector<double> weights;
    for (const MorphSource& source : targets) {
      if (source.node != node) weights = rig.morph_weights(source.node, time);
      node = source.node;
      pose.morph_weights.push_back(weights[source.target]);
    }
    return pose;
  }

  // The cache's frame, from 0, and the part of the way to the next; 0 within the rounding of a file's times.
  std::pair<std::size_t, double> place_in_cache(int frame) const {
    const std::vector<double>& times = cache.times();
    if (times.empty()) return {static_cast<std::size_t>(frame - 1), 0};
    const double time = timeline.time(frame), near = time_rounding / timeline.frames_per_second;
    const auto after = std::upper_bound(times.begin(), times.end(), time + near);
    const auto before = static_cast<std::size_t>(after - times.begin()) - 1;
    if (after == times.end() || time <= times[before] + near) return {before, 0};
    return {before, (time - times[before]) / (times[before + 1] - times[before])};
  }

  // Replaces values that are not finite by those of the last pose.
  template <typename Entry>
  void hold(std::vector<Entry>& entries, const std::vector<Entry>& before, int frame,
            const char* what) const {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (finite(entries[i])) continue;
      entries[i] = before[i];
      log::warn_once("non-finite pose " + path,
                     fmt::format("{}: the pose of frame {} is not finite ({} {}); the last good one is held",
                                 path, frame, what, i));
    }
  }

  void check_frame(int frame) const {
    if (frame < 1 || frame > timeline.frame_count)
      throw Error(ExitCode::bad_input, fmt::format("{}: no frame {}; there are frames 1 to {}", path, frame,
                                                   timeline.frame_count));
  }

  Rig rig;
  Timeline timeline;
  std::string path, clip_name;
  Surface surface;
  std::vector<PaletteEntry> palette;
  std::vector<MorphSource> targets;
  io::VertexCache cache;
  std::vector<std::uint32_t> cache_index;  // per welded vertex, into a frame of the cache
  Pose last;                               // always finite
};

namespace {

std::vector<double> frame_times(const Timeline& timeline) {
  std::vector<double> times(static_cast<std::size_t>(std::min(timeline.frame_count, 1000)));
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = timeline.time(static_cast<int>(i) + 1);
  return times;
}

// In a cache, layers of cloth may touch in the first frame and separate later; only vertices that stay
// together in all frames are one. The cache is read frame by frame, since it may not fit into memory: pairs
// that are joined in the first frame are checked in all frames, and the vertices are joined again without the
// pairs that separated, until no pair does.
Weld weld_instances(const Instances& instances, const io::VertexCache& cache) {
  using Pair = std::pair<std::uint32_t, std::uint32_t>;
  const double tolerance = weld_tolerance(instances.vertices.positions);
  if (cache.empty()) return weld(instances.vertices, tolerance);
  std::set<Pair> watched, parted;  // first and later vertex
  while (true) {
    const Weld result = weld(instances.vertices, tolerance, [&](std::uint32_t a, std::uint32_t b) {
      return !parted.contains({a, b});
    });
    std::vector<Pair> fresh;
    for (std::uint32_t v = 0; v < result.welded.size(); ++v) {
      const Pair pair(result.representative[result.welded[v]], v);
      if (pair.first != v && watched.insert(pair).second) fresh.push_back(pair);
    }
    const std::size_t before = parted.size();
    // At least once, even without pairs, because reading a frame also checks it.
    for (std::size_t f = 0; f < cache.size() && (before == 0 || !fresh.empty()); ++f) {
      const io::VertexCache::Frame frame = cache.frame(f);
      for (const Pair& pair : fresh)
        if (glm::distance((*frame)[instances.cache_index[pair.first]],
                          (*frame)[instances.cache_index[pair.second]]) > tolerance)
          parted.insert(pair);
    }
    if (parted.size() == before) return result;
  }
}

// Vertices of another file in the order of this model's, placed in the world.
std::vector<glm::dvec3> positions_of_file(const io::Model& model, const std::filesystem::path& path,
                                          std::size_t expected, const Limits& limits) {
  // OBJ and PLY files contain neither unit nor up axis: those of the model are assumed.
  io::ImportOptions options;
  options.limits = limits;
  const std::string extension = lower_case(path.extension().string());
  if (extension == ".obj" || extension == ".ply") {
    options.metres_per_unit = model.metres_per_unit;
    options.up = model.up;
  }
  const io::Model other = io::import_model(path, options);
  const Rig rig(other, nullptr);
  const Instances instances = gather_instances(other, rig, {0.0});
  if (instances.vertices.positions.size() != expected)
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: the rest pose has {} vertices, the model {} has {}; they must be the same mesh",
                    path.string(), instances.vertices.positions.size(), model.path.string(), expected));
  return instances.vertices.positions;
}

}  // namespace

Animation::Animation(const io::Model& model, const AnimationChoice& choice) {
  const std::optional<io::Clip> clip =
      model.cache.empty() ? chosen_clip(model, choice.clip) : std::optional<io::Clip>{};
  if (!model.cache.empty() && !choice.clip.empty())
    throw Error(ExitCode::bad_input, fmt::format("{}: clip '{}' asked for, but a sequence has no clips",
                                                 model.path.string(), choice.clip));
  data_ = std::make_unique<Data>(model, choice, clip ? &*clip : nullptr);
  Data& data = *data_;

  Instances instances = gather_instances(model, data.rig, frame_times(data.timeline));
  if (instances.triangles.empty())
    throw Error(ExitCode::bad_input,
                fmt::format("{}: no triangles: there is nothing to wrinkle in it", data.path));
  const Weld weld = weld_instances(instances, model.cache);
  std::vector<glm::dvec3> normals;
  data.surface = build_surface(instances, weld, normals);
  data.palette = std::move(instances.palette);
  data.targets = std::move(instances.targets);
  data.cache = model.cache;
  if (!data.cache.empty())
    for (const std::uint32_t v : weld.representative) data.cache_index.push_back(instances.cache_index[v]);

  // The pose until the clip has a finite one: the bind pose.
  data.last.palette.assign(data.palette.empty() ? 1 : data.palette.size(), glm::dmat4{1});
  for (const MorphSource& source : data.targets) data.last.morph_weights.push_back(source.rest_weight);
  if (!data.cache.empty()) data.last.cache = data.surface.bind;

  Surface& surface = data.surface;
  constexpr std::string_view frame_prefix = "frame:";
  // Flat panels have no place in space (cloth/uv_rest.h): there it is the pose of "auto".
  const bool flat = choice.rest == "uv" || choice.rest.starts_with("uv:");
  if (choice.rest == "auto" || choice.rest == "bind" || flat) {
    Pose rest;
    rest.palette.assign(data.last.palette.size(), glm::dmat4{1});
    for (const MorphSource& source : data.targets)
      rest.morph_weights.push_back(choice.rest != "bind"
                                       ? source.rest_weight
                                       : data.rig.default_morph_weights(source.node)[source.target]);
    if (std::any_of(rest.morph_weights.begin(), rest.morph_weights.end(), [](double w) { return w != 0; }))
      surface.rest = posed(surface, rest);
  } else if (choice.rest.starts_with(frame_prefix)) {
    const std::string number = choice.rest.substr(frame_prefix.size());
    int frame = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), frame);
    if (error != std::errc{} || end != number.data() + number.size())
      throw Error(ExitCode::bad_input,
                  fmt::format("rest pose '{}': expected auto, bind, frame:N or a file", choice.rest));
    data.check_frame(frame);
    Pose rest = data.evaluate(frame);
    data.hold(rest.palette, data.last.palette, frame, "matrix");
    data.hold(rest.morph_weights, data.last.morph_weights, frame, "morph weight");
    data.hold(rest.cache, data.last.cache, frame, "vertex");
    surface.rest = posed(surface, rest);
  } else {
    const std::vector<glm::dvec3> positions =
        positions_of_file(model, choice.rest, instances.vertices.positions.size(), choice.limits);
    for (std::size_t v = 0; v < surface.rest.size(); ++v) surface.rest[v] = positions[weld.representative[v]];
  }
  set_render_normals(surface, normals);
}

Animation::~Animation() = default;

const Surface& Animation::surface() const {
  return data_->surface;
}
Surface& Animation::surface() {
  return data_->surface;
}
const Timeline& Animation::timeline() const {
  return data_->timeline;
}
const std::string& Animation::clip_name() const {
  return data_->clip_name;
}

Pose Animation::pose(int frame) {
  data_->check_frame(frame);
  Pose pose = data_->evaluate(frame);
  data_->hold(pose.palette, data_->last.palette, frame, "matrix");
  data_->hold(pose.morph_weights, data_->last.morph_weights, frame, "morph weight");
  data_->hold(pose.cache, data_->last.cache, frame, "vertex");
  data_->last = pose;
  return pose;
}

glm::dmat4 Animation::node_matrix(int node, int frame) const {
  const std::vector<glm::dmat4> world = data_->rig.world(data_->timeline.time(frame));
  if (node < 0 || static_cast<std::size_t>(node) >= world.size()) return glm::dmat4{1};
  return world[static_cast<std::size_t>(node)];
}

std::vector<glm::dvec3> Animation::samples() const {
  // Enough to fit a camera; its margin allows for points between the samples.
  constexpr int most_frames = 200;
  constexpr std::size_t most_vertices = 5000;
  const Surface& surface = data_->surface;
  const int frames = data_->timeline.frame_count;
  const int count = std::min(frames, most_frames);
  const std::size_t stride = (surface.vertex_count() + most_vertices - 1) / most_vertices;
  std::vector<glm::dvec3> points;
  for (int s = 0; s < count; ++s) {
    const int frame = count == 1 ? 1 : 1 + static_cast<int>(std::int64_t{s} * (frames - 1) / (count - 1));
    for (const glm::dvec3& position : posed(surface, data_->evaluate(frame), stride)) {
      if (finite(position)) points.push_back(position);
    }
  }
  return points.empty() ? surface.rest : points;
}

Animation::Bounds Animation::bounds() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Bounds bounds{glm::dvec3{infinity}, glm::dvec3{-infinity}};
  for (const glm::dvec3& position : samples()) {
    bounds.low = glm::min(bounds.low, position);
    bounds.high = glm::max(bounds.high, position);
  }
  return bounds;
}

std::vector<glm::dvec3> posed(const Surface& surface, const Pose& pose, std::size_t stride) {
  std::vector<glm::dvec3> result;
  const std::size_t count = surface.vertex_count();
  result.reserve(count / stride + 1);
  for (std::size_t v = 0; v < count; v += stride) {
    if (!pose.cache.empty()) {
      result.push_back(pose.cache[v]);
      continue;
    }
    glm::dvec3 bind = surface.bind[v];
    for (std::size_t t = 0; t < surface.target_count; ++t)
      bind += pose.morph_weights[t] * glm::dvec3(surface.target_deltas[t * count + v]);
    const PaletteInfluences& influences = surface.influences[v];
    glm::dvec3 sum{0};
    for (std::size_t i = 0; i < influences.entry.size(); ++i)
      if (influences.weight[i] > 0)
        sum += static_cast<double>(influences.weight[i]) *
               glm::dvec3(pose.palette[influences.entry[i]] * glm::dvec4(bind, 1));
    result.push_back(sum);
  }
  return result;
}

Pose with_cloth(const Surface& surface, Pose pose, const std::vector<std::uint32_t>& welded,
                const std::vector<glm::dvec3>& places) {
  std::vector<glm::dvec3> all = posed(surface, pose), sum(all.size(), glm::dvec3(0));
  std::vector<int> count(all.size(), 0);
  for (std::size_t v = 0; v < welded.size(); ++v) {
    sum[welded[v]] += places[v];
    ++count[welded[v]];
  }
  for (std::size_t v = 0; v < all.size(); ++v)
    if (count[v] > 0) all[v] = sum[v] / static_cast<double>(count[v]);
  pose.palette.assign(1, glm::dmat4{1});
  pose.morph_weights.clear();
  pose.cache = std::move(all);
  return pose;
}

}  // namespace plisse::scene
