// Nodes, clips and weights from an FBX file's own tree (see import_fbx.h).
//
// A node's matrix is T · Roff · Rp · Rpre · R · Rpost⁻¹ · Rp⁻¹ · Soff · Sp · S · Sp⁻¹: a translation, a
// rotation and a scale once more. The inherit types differ in where the parent's scale goes: RSrs has it
// before the child's rotation (plain matrices), RrSs after it, Rrs leaves the parent's own scale out.
#include "io/fbx/import_fbx.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <stdexcept>
#include <string_view>

#include "base/atomic_file.h"
#include "base/log.h"

namespace plisse::io {
namespace {

constexpr std::string_view chain_mark = "_$AssimpFbx$_";
constexpr int deepest = 1000;  // of nodes; a cycle is no deeper than this

// Euler angles in degrees; `order` as FBX numbers them, the first letter turns first.
glm::dquat rotation_of(const glm::dvec3& degrees, int order) {
  static constexpr int axes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};
  const auto& axis = axes[order >= 0 && order < 6 ? order : 0];
  glm::dquat result{1, 0, 0, 0};
  for (const int a : axis) {
    glm::dvec3 around{0};
    around[a] = 1;
    result = glm::angleAxis(glm::radians(degrees[a]), around) * result;
  }
  return result;
}

enum Inherit { RrSs = 0, RSrs = 1, Rrs = 2 };

void sort_unique(std::vector<double>& times) {
  std::sort(times.begin(), times.end());
  times.erase(
      std::unique(times.begin(), times.end(), [](double a, double b) { return std::abs(a - b) < 1e-8; }),
      times.end());
}

template <typename Value, typename Convert>
Keys<Value> keys_of(const FittedKeys& fitted, double start, const Convert& convert) {
  Keys<Value> keys;
  keys.interpolation = Interpolation::cubic_spline;
  for (std::size_t k = 0; k < fitted.times.size(); ++k) {
    keys.times.push_back(fitted.times[k] - start);
    keys.values.push_back(convert(fitted.values[k]));
    keys.in_tangents.push_back(convert(fitted.in_tangents[k]));
    keys.out_tangents.push_back(convert(fitted.out_tangents[k]));
  }
  return keys;
}

double largest(const std::vector<double>& times, const FunctionOfTime& function) {
  double most = 0;
  for (const double time : times)
    for (const double x : function(time, false)) most = std::max(most, std::abs(x));
  return most;
}

}  // namespace

std::unique_ptr<FbxReading> FbxReading::read(const std::filesystem::path& path, const aiScene& scene) {
  std::string why = "its nodes are others than assimp's";
  try {
    std::unique_ptr<FbxReading> reading(new FbxReading(read_whole_text(path)));
    for (const FbxObject& object : reading->scene_.objects())
      if (object.kind == "AnimationStack") reading->takes_.emplace_back(reading->scene_, object);
    if (reading->match(*scene.mRootNode, 0, 0)) {
      reading->tell(path);
      return reading;
    }
  } catch (const std::runtime_error& error) {
    why = error.what();
  }
  log::warn_once("fbx tree " + path.string(),
                 fmt::format("{}: the file's own tree cannot be followed ({}): curves are read as straight "
                             "lines, and weights of shapes, inherit types and visibility are left out",
                             path.string(), why));
  return nullptr;
}

// assimp makes its nodes in the order of the file's connections, each with a chain of pivots before it.
bool FbxReading::match(const aiNode& node, std::int64_t id, int depth) {
  const std::vector<const FbxObject*> children = scene_.sources(id, "Model");
  const aiNode* holder = &node;
  while (holder->mNumChildren == 1 &&
         std::string_view(holder->mChildren[0]->mName.C_Str()).find(chain_mark) != std::string_view::npos &&
         std::string_view(holder->mChildren[0]->mName.C_Str()).ends_with("Inverse"))
    holder = holder->mChildren[0];
  if (depth > deepest || children.size() != holder->mNumChildren) return false;
  for (unsigned c = 0; c < holder->mNumChildren; ++c) {
    const aiNode* child = holder->mChildren[c];
    while (std::string_view(child->mName.C_Str()).find(chain_mark) != std::string_view::npos &&
           child->mNumChildren == 1)
      child = child->mChildren[0];
    models_[child] = children[c];
    if (!match(*child, children[c]->id, depth + 1)) return false;
  }
  return true;
}

// What is in the file and not read, each by name.
void FbxReading::tell(const std::filesystem::path& path) const {
  const auto warn = [&](const char* key, const std::string& text) {
    log::warn_once(std::string("fbx ") + key + path.string(), fmt::format("{}: {}", path.string(), text));
  };
  for (const FbxTake& take : takes_) {
    if (take.layers_used() > 1)
      warn("layers ", fmt::format("clip '{}' has {} animation layers; the first alone is played", take.name(),
                                  take.layers_used()));
    if (take.goes_on())
      warn("extrapolation ",
           fmt::format("curves of clip '{}' go on before or after their keys (extrapolation), "
                       "which is not read: they stay as they are there",
                       take.name()));
  }
  for (const FbxObject& object : scene_.objects()) {
    if (object.kind != "Deformer" && object.kind != "Cache") continue;
    const FbxElement* skinning = object.element->child("SkinningType");
    if (skinning != nullptr && (skinning->text(0) == "DualQuaternion" || skinning->text(0) == "Blend"))
      warn("dual quaternions ", fmt::format("a skin is of dual quaternions (SkinningType {}), which are not "
                                            "read: it is blended linearly",
                                            skinning->text(0)));
    if (object.kind == "Cache" || object.type == "VertexCacheDeformer")
      warn("caches ", "geometry caches are not read; --cache takes MDD and PC2 files");
    if (object.type == "Skin")
      for (const FbxObject* geometry : scene_.targets(object.id, "Geometry"))
        if (scene_.targets(geometry->id, "Model").size() > 1)
          warn("instanced skins ",
               fmt::format(
                   "the skin '{}' is on {} nodes; instances of skins are not read: all stand where its "
                   "bones are",
                   scene_.targets(geometry->id, "Model").front()->name,
                   scene_.targets(geometry->id, "Model").size()));
  }
  for (const FbxTake& take : takes_)
    for (const FbxObject& object : scene_.objects())
      if (object.kind == "Model")
        if (const FbxTrack* track = take.track(object.id, "Visibility")) {
          std::vector<double> times;
          track->add_times(times);
          for (const double time : times)
            if ((track->at(time, false).x > 0) != (track->at(times.front(), false).x > 0)) {
              warn("visibility ",
                   fmt::format("the visibility of '{}' changes in clip '{}', which is not read", object.name,
                               take.name()));
              break;
            }
        }
}

const FbxObject* FbxReading::model_of(const aiNode& node) const {
  const auto found = models_.find(&node);
  return found == models_.end() ? nullptr : found->second;
}

const FbxObject* FbxReading::parent(const FbxObject& model) const {
  const std::vector<const FbxObject*> parents = scene_.targets(model.id, "Model");
  return parents.empty() ? nullptr : parents.front();
}

glm::dvec3 FbxReading::property(const FbxObject& model, std::string_view name, const glm::dvec3& otherwise,
                                const FbxTake* take, double time, bool from_left) const {
  if (take != nullptr)
    if (const FbxTrack* track = take->track(model.id, name)) return track->at(time, from_left);
  return scene_.vector(model, name, otherwise);
}

bool FbxReading::parent_unscaled(const FbxObject& model) const {
  const auto inherit = static_cast<int>(scene_.number(model, "InheritType", RrSs));
  const FbxObject* above = parent(model);
  if (inherit == RSrs || above == nullptr) return false;
  // Where the parent's scale is even and still, plain matrices do the same for RrSs.
  const FbxObject* one = above;
  for (int depth = 0; one != nullptr && depth < deepest; ++depth) {
    for (const FbxTake& take : takes_)
      if (take.track(one->id, "Lcl Scaling") != nullptr) return true;
    if (static_cast<int>(scene_.number(*one, "InheritType", RrSs)) == RSrs) break;
    one = parent(*one);
  }
  const glm::dvec3 scale = whole_scale(*above, nullptr, 0, false, 0);
  const bool even = scale.x == scale.y && scale.y == scale.z;
  return !even || (inherit == Rrs && scene_.vector(*above, "Lcl Scaling", glm::dvec3{1}) != glm::dvec3{1});
}

bool FbxReading::needs_unscaled(const FbxObject& model) const {
  for (const FbxObject* child : scene_.sources(model.id, "Model"))
    if (parent_unscaled(*child)) return true;
  return false;
}

// The scale that a node has beside its turned and placed axes.
glm::dvec3 FbxReading::whole_scale(const FbxObject& model, const FbxTake* take, double time, bool from_left,
                                   int depth) const {
  const auto own = [&](const FbxObject& of) {
    return property(of, "Lcl Scaling", glm::dvec3{1}, take, time, from_left);
  };
  const FbxObject* above = parent(model);
  if (depth > deepest || above == nullptr || !parent_unscaled(model)) return own(model);
  glm::dvec3 inherited = whole_scale(*above, take, time, from_left, depth + 1);
  if (static_cast<int>(scene_.number(model, "InheritType", RrSs)) == Rrs) {
    const glm::dvec3 of_parent = own(*above);
    for (int axis = 0; axis < 3; ++axis)
      inherited[axis] = of_parent[axis] != 0 ? inherited[axis] / of_parent[axis] : 1;
  }
  return inherited * own(model);
}

FbxReading::Parts FbxReading::parts(const FbxObject& model, const FbxTake* take, double time,
                                    bool from_left) const {
  const glm::dvec3 zero{0};
  const auto still = [&](std::string_view name) { return scene_.vector(model, name, zero); };
  const auto order = static_cast<int>(scene_.number(model, "RotationOrder", 0));
  const glm::dvec3 scale = property(model, "Lcl Scaling", glm::dvec3{1}, take, time, from_left);
  const glm::dvec3 rotation_pivot = still("RotationPivot"), scaling_pivot = still("ScalingPivot");
  Parts parts;
  parts.rotation = rotation_of(still("PreRotation"), 0) *
                   rotation_of(property(model, "Lcl Rotation", zero, take, time, from_left), order) *
                   glm::inverse(rotation_of(still("PostRotation"), 0));
  parts.translation =
      property(model, "Lcl Translation", zero, take, time, from_left) + still("RotationOffset") +
      rotation_pivot +
      parts.rotation * (still("ScalingOffset") + scaling_pivot - rotation_pivot - scale * scaling_pivot);
  parts.scale = scale;
  if (parent_unscaled(model)) {
    parts.translation *= whole_scale(*parent(model), take, time, from_left, 0);
    parts.scale = whole_scale(model, take, time, from_left, 0);
  }
  return parts;
}

bool FbxReading::visible(const FbxObject& model) const {
  const FbxObject* one = &model;
  for (int depth = 0; one != nullptr && depth < deepest; ++depth) {
    bool shown = scene_.number(*one, "Visibility", 1) > 0;
    // A curve decides where there is one.
    for (const FbxTake& take : takes_)
      if (const FbxTrack* track = take.track(one->id, "Visibility")) {
        std::vector<double> times;
        track->add_times(times);
        shown = std::any_of(times.begin(), times.end(),
                            [&](double time) { return track->at(time, false).x > 0; });
      }
    if (!shown || (one == &model && scene_.number(*one, "Show", 1) == 0)) return false;
    if (scene_.number(*one, "Visibility Inheritance", 1) == 0) return true;
    one = parent(*one);
  }
  return true;
}

std::vector<double> FbxReading::weights(const FbxObject& model, std::size_t targets, const FbxTake* take,
                                        double time, bool from_left) const {
  // As assimp has them: of each shape deformer the channels, of each channel its shapes.
  std::vector<double> result;
  for (const FbxObject* geometry : scene_.sources(model.id, "Geometry"))
    for (const FbxObject* deformer : scene_.sources(geometry->id, "Deformer")) {
      if (deformer->type != "BlendShape") continue;
      for (const FbxObject* channel : scene_.sources(deformer->id, "Deformer")) {
        if (channel->type != "BlendShapeChannel") continue;
        const FbxElement* stated = channel->element->child("DeformPercent");
        double percent = scene_.number(*channel, "DeformPercent", stated == nullptr ? 0 : stated->number(0));
        if (take != nullptr)
          if (const FbxTrack* track = take->track(channel->id, "DeformPercent"))
            percent = track->at(time, from_left).x;
        const std::size_t shapes = scene_.sources(channel->id, "Geometry").size();
        std::vector<double> full;
        if (const FbxElement* list = channel->element->child("FullWeights")) {
          try {
            full = list->numbers();
          } catch (const std::runtime_error&) {
            full.clear();
          }
        }
        while (full.size() < shapes)
          full.push_back(100.0 * static_cast<double>(full.size() + 1) / static_cast<double>(shapes));
        const std::size_t first = result.size();
        result.resize(first + shapes, 0);
        if (shapes == 0) continue;
        // Between its shapes a channel goes straight from one to the next, and on beyond the last.
        std::size_t next = 0;
        while (next + 1 < shapes && percent > full[next]) ++next;
        const double below = next == 0 ? 0 : full[next - 1];
        const double part = full[next] != below ? (percent - below) / (full[next] - below) : 1;
        result[first + next] = part;
        if (next > 0) result[first + next - 1] = 1 - part;
      }
    }
  if (result.size() != targets) result.clear();
  return result;
}

std::vector<MorphTarget> FbxReading::lost_targets(const aiNode& holder, unsigned mesh,
                                                  const aiMesh& source) const {
  std::vector<MorphTarget> targets;
  const FbxObject* model = model_of(holder);
  if (model == nullptr) return targets;
  const std::vector<const FbxObject*> geometries = scene_.sources(model->id, "Geometry");
  if (geometries.size() != 1) return targets;
  std::vector<const FbxObject*> shapes;
  std::vector<const FbxObject*> channels;
  for (const FbxObject* deformer : scene_.sources(geometries[0]->id, "Deformer"))
    if (deformer->type == "BlendShape")
      for (const FbxObject* channel : scene_.sources(deformer->id, "Deformer"))
        if (channel->type == "BlendShapeChannel")
          for (const FbxObject* shape : scene_.sources(channel->id, "Geometry")) {
            shapes.push_back(shape);
            channels.push_back(channel);
          }
  if (shapes.size() == source.mNumAnimMeshes) return targets;
  try {
    // assimp has a vertex for each corner; of several materials one mesh each, in the order of their first
    // polygons.
    const FbxElement* corners = geometries[0]->element->child("PolygonVertexIndex");
    const FbxElement* layer = geometries[0]->element->child("LayerElementMaterial");
    const FbxElement* list = layer == nullptr ? nullptr : layer->child("Materials");
    const std::vector<std::int64_t> materials =
        list == nullptr ? std::vector<std::int64_t>() : list->integers();
    std::vector<std::int64_t> met;
    for (const std::int64_t material : materials)
      if (std::find(met.begin(), met.end(), material) == met.end()) met.push_back(material);
    const bool split = holder.mNumMeshes > 1;
    unsigned ordinal = 0;
    while (ordinal < holder.mNumMeshes && holder.mMeshes[ordinal] != mesh) ++ordinal;
    if (corners == nullptr || (split && ordinal >= met.size())) return targets;
    std::vector<std::int64_t> points;
    std::size_t polygon = 0;
    for (const std::int64_t corner : corners->integers()) {
      const bool own = !split || (polygon < materials.size() && materials[polygon] == met[ordinal]);
      if (own) points.push_back(corner < 0 ? -corner - 1 : corner);
      polygon += corner < 0 ? 1 : 0;
    }
    if (points.size() != source.mNumVertices) return targets;
    for (std::size_t s = 0; s < shapes.size(); ++s) {
      const FbxElement* indices = shapes[s]->element->child("Indexes");
      const FbxElement* vertices = shapes[s]->element->child("Vertices");
      MorphTarget& target = targets.emplace_back();
      target.name = channels[s]->name;
      target.position_deltas.assign(points.size(), glm::vec3{0});
      if (indices == nullptr || vertices == nullptr) continue;
      const std::vector<std::int64_t> of = indices->integers();
      const std::vector<double> by = vertices->numbers();
      std::unordered_map<std::int64_t, std::size_t> place;
      for (std::size_t i = 0; i < of.size() && 3 * i + 2 < by.size(); ++i) place[of[i]] = i;
      for (std::size_t v = 0; v < points.size(); ++v)
        if (const auto found = place.find(points[v]); found != place.end())
          target.position_deltas[v] =
              glm::vec3(by[3 * found->second], by[3 * found->second + 1], by[3 * found->second + 2]);
    }
  } catch (const std::runtime_error&) {
    targets.clear();
  }
  return targets;
}

std::vector<double> FbxReading::knots(const FbxObject& model, const FbxTake& take) const {
  std::vector<double> times{take.start(), take.stop()};
  const auto add = [&](const FbxObject& of, std::string_view name) {
    if (const FbxTrack* track = take.track(of.id, name)) track->add_times(times);
  };
  for (const std::string_view name : {"Lcl Translation", "Lcl Rotation", "Lcl Scaling"}) add(model, name);
  const FbxObject* one = &model;
  for (int depth = 0; depth < deepest && parent_unscaled(*one); ++depth) {
    one = parent(*one);
    add(*one, "Lcl Scaling");
  }
  if (times.size() == 2) return {};
  std::erase_if(times, [&](double time) { return time < take.start() || time > take.stop(); });
  sort_unique(times);
  // No piece turns by more than a quarter: quaternions cannot tell whole turns.
  if (take.track(model.id, "Lcl Rotation") != nullptr) {
    const std::size_t keys = times.size();
    for (std::size_t k = 0; k + 1 < keys; ++k) {
      const double length = times[k + 1] - times[k];
      double turn = 0;
      glm::dvec3 before = property(model, "Lcl Rotation", glm::dvec3{0}, &take, times[k], false);
      for (int step = 1; step <= 8; ++step) {
        const glm::dvec3 now =
            property(model, "Lcl Rotation", glm::dvec3{0}, &take, times[k] + length * step / 8, true);
        turn += glm::length(now - before);
        before = now;
      }
      const int pieces = static_cast<int>(std::min(1000.0, std::ceil(turn / 90)));
      for (int piece = 1; piece < pieces; ++piece) times.push_back(times[k] + length * piece / pieces);
    }
    sort_unique(times);
  }
  return times;
}

void FbxReading::add_channel(const FbxObject& model, const FbxTake& take, Clip& clip) const {
  const auto place = places_.find(model.id);
  const std::vector<double> times = knots(model, take);
  if (place == places_.end() || times.empty()) return;
  const auto three = [](const glm::dvec3& v) { return std::vector<double>{v.x, v.y, v.z}; };
  const FunctionOfTime translation = [&](double time, bool left) {
    return three(parts(model, &take, time, left).translation);
  };
  const FunctionOfTime rotation = [&](double time, bool left) {
    const glm::dquat q = parts(model, &take, time, left).rotation;
    return std::vector<double>{q.w, q.x, q.y, q.z};
  };
  const FunctionOfTime scale = [&](double time, bool left) {
    return three(parts(model, &take, time, left).scale);
  };
  const auto vector = [](const std::vector<double>& v) { return glm::dvec3(v[0], v[1], v[2]); };
  constexpr double tolerance = 1e-7;
  Channel turned;
  turned.node = place->second.turned;
  turned.translation = keys_of<glm::dvec3>(
      fit_keys(translation, times, tolerance * std::max(1e-9, largest(times, translation))), take.start(),
      vector);
  turned.rotation =
      keys_of<glm::dquat>(fit_keys(rotation, times, tolerance, true), take.start(),
                          [](const std::vector<double>& v) { return glm::dquat(v[0], v[1], v[2], v[3]); });
  Keys<glm::dvec3> scales = keys_of<glm::dvec3>(
      fit_keys(scale, times, tolerance * std::max(1e-9, largest(times, scale))), take.start(), vector);
  if (place->second.scaled == place->second.turned) {
    turned.scale = std::move(scales);
    clip.channels.push_back(std::move(turned));
    return;
  }
  Channel scaled;
  scaled.node = place->second.scaled;
  scaled.scale = std::move(scales);
  clip.channels.push_back(std::move(turned));
  clip.channels.push_back(std::move(scaled));
}

void FbxReading::add_weights(const FbxTake& take, Model& model, Clip& clip) const {
  for (const auto& [id, place] : places_) {
    const FbxObject& object = *scene_.object(id);
    std::vector<double> times{take.start(), take.stop()};
    for (const FbxObject* geometry : scene_.sources(id, "Geometry"))
      for (const FbxObject* deformer : scene_.sources(geometry->id, "Deformer"))
        for (const FbxObject* channel : scene_.sources(deformer->id, "Deformer"))
          if (const FbxTrack* track = take.track(channel->id, "DeformPercent")) track->add_times(times);
    if (times.size() == 2) continue;
    std::erase_if(times, [&](double time) { return time < take.start() || time > take.stop(); });
    sort_unique(times);
    // The meshes hang under the node or under a holder of the same name (hang_meshes).
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {
      const Node& node = model.nodes[n];
      const bool own = static_cast<int>(n) == place.scaled ||
                       (node.parent == place.scaled && !node.meshes.empty() &&
                        node.name == model.nodes[static_cast<std::size_t>(place.scaled)].name);
      const std::size_t targets = node.morph_weights.size();
      if (!own || targets == 0 || weights(object, targets, nullptr, 0, false).empty()) continue;
      const FunctionOfTime function = [&](double time, bool left) {
        return weights(object, targets, &take, time, left);
      };
      auto known = std::find_if(clip.channels.begin(), clip.channels.end(),
                                [&](const Channel& one) { return one.node == static_cast<int>(n); });
      if (known == clip.channels.end()) {
        clip.channels.emplace_back().node = static_cast<int>(n);
        known = clip.channels.end() - 1;
      }
      known->morph_weights = keys_of<std::vector<double>>(fit_keys(function, times, 1e-7), take.start(),
                                                          [](const std::vector<double>& v) { return v; });
    }
  }
}

void FbxReading::read_clips(Model& model) const {
  for (const FbxTake& take : takes_) {
    Clip clip;
    clip.name = take.name().empty() ? fmt::format("clip {}", model.clips.size()) : take.name();
    clip.duration = std::max(0.0, take.stop() - take.start());
    for (const FbxObject& object : scene_.objects())
      if (object.kind == "Model") add_channel(object, take, clip);
    add_weights(take, model, clip);
    if (!clip.channels.empty()) model.clips.push_back(std::move(clip));
  }
}

}  // namespace plisse::io
