#include "passes/render.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "gpu/context.h"

namespace plisse::passes {
namespace {

constexpr double ground_reach = 3.2;    // half the ground map's side, in radii of the model
constexpr double sphere_margin = 1.02;  // of the depth maps: the sphere that they hold, in radii of the model
constexpr double contact_reach = 0.05;  // how far above the floor the surface still darkens it, in radii

// std140 layout of common/scene.glsl.
struct SceneBlock {
  glm::mat4 view_projection, shadow_matrix;
  glm::vec4 eye, up;
  struct {
    glm::vec4 direction, colour;
  } lights[3];
  glm::vec4 ambient, surface, shadow_texel;
};

glm::vec4 wide(const glm::dvec3& v, double w = 0) {
  return {glm::vec3(v), static_cast<float>(w)};
}

// A parallel projection along `direction` (the way the light goes) that holds the sphere (centre, radius):
// world → clip.
glm::dmat4 parallel_projection(const glm::dvec3& centre, double radius, const glm::dvec3& direction) {
  const glm::dvec3 helper = std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  return glm::ortho(-radius, radius, -radius, radius, 0.0, 2 * radius) *
         glm::lookAt(centre - radius * direction, centre, helper);
}

glm::dmat4 clip_to_unit() {
  return glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(0.5)), glm::dvec3(0.5));
}

void uniform(const gpu::Program& p, const char* name, float value) {
  glUniform1f(p.uniform(name), value);
}
void uniform(const gpu::Program& p, const char* name, int value) {
  glUniform1i(p.uniform(name), value);
}
void uniform(const gpu::Program& p, const char* name, const glm::vec2& v) {
  glUniform2fv(p.uniform(name), 1, &v.x);
}
void uniform(const gpu::Program& p, const char* name, const glm::dvec3& v) {
  const glm::vec3 f(v);
  glUniform3fv(p.uniform(name), 1, &f.x);
}
void uniform(const gpu::Program& p, const char* name, const glm::vec4& v) {
  glUniform4fv(p.uniform(name), 1, &v.x);
}
void uniform(const gpu::Program& p, const char* name, const glm::dmat4& m) {
  const glm::mat4 f(m);
  glUniformMatrix4fv(p.uniform(name), 1, GL_FALSE, glm::value_ptr(f));
}

bool has_holes(const DrawPart& part) {
  return part.has_alpha || part.alpha_cutoff > 0;
}

// Features that a part's material needs beyond the plain shader; each costs time, so a shader has only those
// it uses.
constexpr unsigned with_alpha = 1, with_normal_map = 2, with_colours = 4, with_texture = 8;
unsigned features_of(const DrawPart& part) {
  return (has_holes(part) ? with_alpha : 0U) | (part.normal_texture >= 0 ? with_normal_map : 0U) |
         (part.has_colours ? with_colours : 0U) | (part.texture >= 0 ? with_texture : 0U);
}
// Features that its waves do not need in this frame.
constexpr unsigned without_waves = 16, faded_waves = 32, only_field = 64;

// The floor's own axes and the corner of the ground map.
struct GroundFrame {
  glm::dvec3 across, along, origin;
  glm::dvec3 foot;  // vertically below the model's centre: the middle of the map
  double side;
  explicit GroundFrame(const View& view) {
    const glm::dvec3 up = view.up;
    across = glm::normalize(glm::cross(std::abs(up.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1), up));
    along = glm::cross(up, across);
    side = 2 * ground_reach * view.bounds_radius;
    foot = view.bounds_centre + (view.floor - glm::dot(view.bounds_centre, up)) * up;
    origin = foot - 0.5 * side * (across + along);
  }
};

// The texels of the ground map that the model can darken, and `reach` more on each side for the blur: those
// in the shadow of the sphere that the depth maps contain, and those below it. All others are zero.
gpu::Rectangle darkened_texels(const GroundFrame& ground, const View& view, int size, int reach) {
  const glm::dvec3 light = view.lights[0].direction;
  const double radius = sphere_margin * view.bounds_radius, texel = ground.side / size;
  const double climb = glm::dot(light, view.up);
  // A light at the height of the floor would cast an endless shadow; for one below it the depth map decides.
  if (climb < 1e-3) return {0, 0, size, size};
  const glm::dvec3 shadow =
      view.bounds_centre + (view.floor - glm::dot(view.bounds_centre, view.up)) / climb * light;
  const auto range = [&](const glm::dvec3& axis) {
    const double slant = glm::dot(light, axis) / climb, from = glm::dot(ground.origin, axis);
    const double below = glm::dot(ground.foot, axis) - from, thrown = glm::dot(shadow, axis) - from;
    const double low = std::min(below - radius, thrown - radius * std::sqrt(1 + slant * slant));
    const double high = std::max(below + radius, thrown + radius * std::sqrt(1 + slant * slant));
    // Two texels for the depth maps' own bilinear reading.
    return std::pair(std::clamp(static_cast<int>(std::floor(low / texel)) - reach - 2, 0, size),
                     std::clamp(static_cast<int>(std::ceil(high / texel)) + reach + 2, 0, size));
  };
  const auto [left, right] = range(ground.across);
  const auto [low, high] = range(ground.along);
  return {left, low, right - left, high - low};
}

}  // namespace

RenderPass::RenderPass(const Look& look, const Profile& profile, std::vector<DrawPart> parts,
                       const std::vector<std::vector<TextureLevel>>& textures,
                       const std::string& shader_folder)
    : look_(look),
      profile_(profile),
      profile_texture_(profile),
      parts_(std::move(parts)),
      shader_folder_(shader_folder) {
  surface_ = make_programs(surface_files(), picture_defines());
  if (look.shadows || look.ground) depth_ = gpu::Program({"depth.vert", "flat.frag"}, {}, shader_folder);
  if (look.wireframe) lines_ = gpu::Program({"depth.vert", "flat.frag"}, {}, shader_folder);
  if (look.ground) {
    backdrop_ = gpu::Program({"backdrop.vert", "backdrop.frag"}, {}, shader_folder);
    ground_cast_ = gpu::Program({"ground.comp"}, {{"CAST", "1"}}, shader_folder);
    ground_blur_ = gpu::Program({"ground.comp"}, {{"BLUR", "1"}}, shader_folder);
    glCreateTextures(GL_TEXTURE_2D, 2, ground_textures_.data());
    for (unsigned texture : ground_textures_) {
      glTextureStorage2D(texture, 1, GL_RG16F, ground_size, ground_size);
      glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
      glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
      glTextureParameteri(texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
      glTextureParameteri(texture, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    top_texture_ = depth_map(top_framebuffer_, below_size);
  }
  if (look.shadows || look.ground) {
    shadow_texture_ = depth_map(shadow_framebuffer_, shadow_size);
    glTextureParameteri(shadow_texture_, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(shadow_texture_, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  }
  for (const auto& levels : textures) textures_.emplace_back(levels);
  scene_ = gpu::Buffer(sizeof(SceneBlock));
  glCreateVertexArrays(1, &vertex_array_);
  gpu::check("while preparing to render");
}

gpu::Defines RenderPass::surface_defines() const {
  if (look_.displaced) return {{"PLAIN", "1"}, {"DISPLACED", "1"}};
  gpu::Defines defines = wave_defines(profile_, look_.smooth_blend);
  if (look_.plain) defines.emplace_back("PLAIN", "1");
  if (look_.full_gradient) defines.emplace_back("FULL_GRADIENT", "1");
  if (look_.field) defines.emplace_back("FIELD", "1");
  return defines;
}

gpu::Defines RenderPass::picture_defines() const {
  gpu::Defines defines = surface_defines();
  if (look_.shadows) defines.emplace_back("SHADOWS", "1");
  return defines;
}

std::vector<std::string> RenderPass::surface_files() const {
  return {"render.vert", look_.phong ? "phong.frag" : "render.frag"};
}

RenderPass::~RenderPass() {
  const unsigned textures[] = {shadow_texture_, top_texture_, ground_textures_[0], ground_textures_[1]};
  glDeleteTextures(4, textures);
  const unsigned framebuffers[] = {shadow_framebuffer_, top_framebuffer_};
  glDeleteFramebuffers(2, framebuffers);
  glDeleteVertexArrays(1, &vertex_array_);
}

unsigned RenderPass::depth_map(unsigned& framebuffer, int size) {
  unsigned texture = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, GL_DEPTH_COMPONENT32F, size, size);
  glTextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(texture, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glCreateFramebuffers(1, &framebuffer);
  glNamedFramebufferTexture(framebuffer, GL_DEPTH_ATTACHMENT, texture, 0);
  glNamedFramebufferDrawBuffer(framebuffer, GL_NONE);
  return texture;
}

void RenderPass::write_scene(const View& view) {
  SceneBlock block{};
  block.view_projection = glm::mat4(view.view_projection);
  block.shadow_matrix = glm::mat4(shadow_matrix_);
  block.eye = wide(view.eye, 1);
  block.up = wide(view.up);
  for (std::size_t i = 0; i < 3; ++i) {
    block.lights[i].direction = wide(view.lights[i].direction);
    block.lights[i].colour = wide(view.lights[i].colour);
  }
  block.ambient = wide(view.ambient, look_.sheen);
  block.surface =
      glm::vec4(std::pow(look_.roughness, 4), look_.cavity, look_.parallax, profile_.slope_variance);
  block.shadow_texel = glm::vec4(1.0 / shadow_size, shadow_texel_, shadow_offset, 0);
  scene_.write(&block, sizeof block);
  scene_.bind_uniform(1);
}

void RenderPass::bind_surface(const SurfaceBuffers& surface) {
  surface.bind_for_reading();
  surface.triangle_corners.bind_items(SurfaceBuffers::own_unit, gpu::Buffer::Item::uvec2);
  surface.render_vertices.bind_items(SurfaceBuffers::own_unit + 1, gpu::Buffer::Item::vec4);
  if (std::any_of(parts_.begin(), parts_.end(), [](const DrawPart& part) { return part.has_colours; }))
    surface.render_colours.bind_items(SurfaceBuffers::own_unit + 2, gpu::Buffer::Item::vec4);
  if (look_.displaced)
    surface.relief.bind_items(SurfaceBuffers::own_unit + 3, gpu::Buffer::Item::vec4);
  else if (look_.field)
    surface.field.bind_items(SurfaceBuffers::own_unit + 3, gpu::Buffer::Item::vec4);
  profile_texture_.bind();
  glBindVertexArray(vertex_array_);
}

void RenderPass::draw_shadow_map(const SurfaceBuffers& surface, const View& view) {
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);
  glClearDepth(1.0);
  depth_.use();
  uniform(depth_, "pull", 0.0F);
  const auto draw = [&](unsigned framebuffer, int size, const glm::dmat4& matrix) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, size, size);
    glClear(GL_DEPTH_BUFFER_BIT);
    uniform(depth_, "to_clip", matrix);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * surface.triangle_count));
  };
  const double radius = sphere_margin * view.bounds_radius;
  const glm::dmat4 light = parallel_projection(view.bounds_centre, radius, -view.lights[0].direction);
  shadow_matrix_ = clip_to_unit() * light;
  shadow_texel_ = 2 * radius / shadow_size;
  draw(shadow_framebuffer_, shadow_size, light);
  if (look_.ground) {
    // From below, looking up: the nearest surface is the lowest one, its depth the height above the floor.
    const glm::dvec3 centre =
        view.bounds_centre + (view.floor + radius - glm::dot(view.bounds_centre, view.up)) * view.up;
    const glm::dmat4 top = parallel_projection(centre, radius, view.up);
    top_matrix_ = clip_to_unit() * top;
    draw(top_framebuffer_, below_size, top);
  }
}

void RenderPass::draw_ground_map(const View& view) {
  const GroundFrame ground(view);
  const double texel = ground.side / ground_size;
  const glm::vec2 widths(std::max(0.7, 0.035 * view.bounds_radius / texel),
                         std::max(0.7, 0.06 * view.bounds_radius / texel));
  const int reach = static_cast<int>(std::ceil(2.5F * std::max(widths.x, widths.y)));
  const gpu::Rectangle area = darkened_texels(ground, view, ground_size, reach);
  if (area != ground_area_) {
    for (unsigned texture : ground_textures_) glClearTexImage(texture, 0, GL_RG, GL_FLOAT, nullptr);
    ground_area_ = area;
  }
  if (area.empty()) return;
  const auto run = [&](const gpu::Program& program, unsigned result) {
    uniform(program, "size", ground_size);
    glUniform4i(program.uniform("area"), area.x, area.y, area.x + area.width, area.y + area.height);
    glBindImageTexture(0, result, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RG16F);
    glDispatchCompute(static_cast<GLuint>(area.width + 7) / 8, static_cast<GLuint>(area.height + 7) / 8, 1);
    // Barriers for: the next pass and the backdrop, which fetch it; overwriting, clearing and reading back.
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT |
                    GL_TEXTURE_UPDATE_BARRIER_BIT);
  };
  ground_cast_.use();
  glBindTextureUnit(2, shadow_texture_);
  glBindTextureUnit(4, top_texture_);
  uniform(ground_cast_, "shadow_matrix", shadow_matrix_);
  uniform(ground_cast_, "height_matrix", top_matrix_);
  uniform(ground_cast_, "map_origin", wide(ground.origin, ground.side));
  uniform(ground_cast_, "map_across", ground.across);
  uniform(ground_cast_, "map_along", ground.along);
  const double range = 2 * sphere_margin * view.bounds_radius;
  uniform(ground_cast_, "heights_per_reach",
          static_cast<float>(range / (contact_reach * view.bounds_radius)));
  run(ground_cast_, ground_textures_[0]);
  ground_blur_.use();
  uniform(ground_blur_, "widths", widths);
  for (int axis = 0; axis < 2; ++axis) {
    glBindTextureUnit(3, ground_textures_[static_cast<std::size_t>(axis)]);
    glUniform2i(ground_blur_.uniform("axis"), axis == 0, axis == 1);
    run(ground_blur_, ground_textures_[static_cast<std::size_t>(1 - axis)]);
  }
}

void RenderPass::draw_backdrop(const View& view, bool under) {
  const GroundFrame ground(view);
  GLint viewport[4];
  glGetIntegerv(GL_VIEWPORT, viewport);
  backdrop_.use();
  uniform(backdrop_, "from_clip", glm::inverse(view.view_projection));
  uniform(backdrop_, "background", wide(look_.background, 1));
  uniform(backdrop_, "picture_size", glm::vec2(viewport[2], viewport[3]));
  uniform(backdrop_, "floor_plane", wide(view.up, view.floor));
  uniform(backdrop_, "map_origin", wide(ground.origin, ground.side));
  uniform(backdrop_, "map_across", ground.across);
  uniform(backdrop_, "map_along", ground.along);
  glBindTextureUnit(3, ground_textures_[0]);
  glDisable(GL_DEPTH_TEST);
  if (under) glEnable(GL_BLEND);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);  // the colours in the target are premultiplied
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

gpu::Program RenderPass::make_program(const std::vector<std::string>& files, gpu::Defines defines,
                                      unsigned features) const {
  if (features & with_alpha) defines.emplace_back("ALPHA", "1");
  if (features & with_normal_map) defines.emplace_back("NORMAL_MAP", "1");
  if (features & with_colours) defines.emplace_back("VERTEX_COLOURS", "1");
  if (features & with_texture) defines.emplace_back("TEXTURED", "1");
  if (features & without_waves) defines.emplace_back("PLAIN", "1");
  if (features & faded_waves) defines.emplace_back("FADED", "1");
  if (features & only_field) defines.emplace_back("FIELD_ALONE", "1");
  return {files, defines, shader_folder_};
}

RenderPass::Programs RenderPass::make_programs(const std::vector<std::string>& files,
                                               const gpu::Defines& defines) const {
  Programs programs;
  for (const DrawPart& part : parts_) {
    const unsigned features = features_of(part);
    if (!programs.contains(features)) programs.emplace(features, make_program(files, defines, features));
  }
  return programs;
}

void RenderPass::draw_parts(Programs& programs, bool blended, bool as_shown) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const DrawPart& part = parts_[i];
    if (part.has_alpha != blended || part.triangle_count == 0) continue;
    if (as_shown && !shown_[i].in_view) continue;
    unsigned features = features_of(part);
    if (as_shown && shown_[i].waves != Detail::full) {
      features |= shown_[i].waves == Detail::none    ? without_waves
                  : shown_[i].waves == Detail::faded ? faded_waves
                                                     : only_field;
      // Compiled at its first use: most runs need only one of each kind.
      if (!programs.contains(features))
        programs.emplace(features, make_program(surface_files(), picture_defines(), features));
    }
    const gpu::Program& program = programs.at(features);
    program.use();
    if (part.texture >= 0) {
      const Texture& texture = textures_[static_cast<std::size_t>(part.texture)];
      texture.bind(0);
      uniform(program, "texture_size", glm::vec2(texture.width(), texture.height()));
    }
    uniform(program, "base_colour", part.base_colour);
    if (part.normal_texture >= 0) {
      const Texture& map = textures_[static_cast<std::size_t>(part.normal_texture)];
      map.bind(5);
      uniform(program, "normal_map_size", glm::dvec3(map.width(), map.height(), part.normal_scale));
    }
    uniform(program, "alpha_cutoff", part.alpha_cutoff);
    uniform(program, "has_alpha", static_cast<int>(part.has_alpha));
    uniform(program, "object", static_cast<float>(i + 1));
    part.two_sided ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
    const auto draw_side = [&](float side) {
      uniform(program, "wanted_side", side);
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(3 * part.first_triangle),
                   static_cast<GLsizei>(3 * part.triangle_count));
    };
    // Draws back faces first: the far side of a veil is behind its near side.
    if (blended && part.two_sided) {
      draw_side(-1);
      draw_side(1);
    } else {
      draw_side(0);
    }
  }
  glDisable(GL_CULL_FACE);
}

const PartShapes& RenderPass::shapes_of(const SurfaceBuffers& surface) {
  if (!shapes_ || !shapes_->belongs_to(surface)) {
    std::vector<PartShapes::Range> ranges;
    for (const DrawPart& part : parts_) ranges.push_back({part.first_triangle, part.triangle_count});
    shapes_.emplace(surface, ranges);
  }
  return *shapes_;
}

gpu::Rectangle RenderPass::choose(const SurfaceBuffers& surface, const View& view, const gpu::Target& target,
                                  bool software) {
  const int width = target.width(), height = target.height();
  shown_.assign(parts_.size(), {});
  left_out_ = {};
  const bool has_waves = !look_.plain && !look_.displaced;
  const bool idle = has_waves && !surface.any_height(), flat = idle && !look_.field;
  gpu::Rectangle area;
  std::optional<PartShapes::Posed> posed;
  if (software) posed = shapes_of(surface).posed(surface, view.view_projection, width, height);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const DrawPart& part = parts_[i];
    if (part.triangle_count == 0) continue;
    Shown& shown = shown_[i];
    if (posed) {
      const gpu::Rectangle its = posed->covered(i);
      shown.in_view = !its.empty();
      if (!shown.in_view) {
        ++left_out_.out_of_view;
        continue;
      }
      area = area.empty() ? its : area.united(its);
    }
    if (part.texture < 0 && part.normal_texture < 0 && has_waves) ++left_out_.untextured;
    if (has_waves && (flat || !part.wrinkles)) {
      shown.waves = Detail::none;
      ++left_out_.flat;
    } else if (has_waves && posed && !look_.field && posed->waves_are_too_fine(i)) {
      shown.waves = Detail::faded;
      ++left_out_.too_fine;
    } else if (idle) {
      shown.waves = Detail::field_alone;
    }
  }
  left_out_.nothing_in_view = software && area.empty();
  return software ? area : gpu::Rectangle{0, 0, width, height};
}

void RenderPass::clear(bool with_depth) {
  const glm::vec4 colour = look_.transparent || look_.ground ? glm::vec4(0) : wide(look_.background, 1);
  glClearColor(colour.r, colour.g, colour.b, colour.a);
  glDepthMask(GL_TRUE);
  glClear(with_depth ? GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT : GL_COLOR_BUFFER_BIT);
}

void RenderPass::draw_all(const SurfaceBuffers& surface, const View& view, const gpu::Target& target) {
  shown_.assign(parts_.size(), {});
  left_out_ = {};
  draw(surface, view, target, {0, 0, target.width(), target.height()});
}

bool RenderPass::draw(const SurfaceBuffers& surface, const View& view, const gpu::Target& target,
                      bool software) {
  draw(surface, view, target, choose(surface, view, target, software));
  return !left_out_.nothing_in_view;
}

void RenderPass::draw(const SurfaceBuffers& surface, const View& view, const gpu::Target& target,
                      const gpu::Rectangle& area) {
  glDisable(GL_FRAMEBUFFER_SRGB);
  bind_surface(surface);
  if (look_.shadows || look_.ground) draw_shadow_map(surface, view);
  if (look_.ground) draw_ground_map(view);
  write_scene(view);
  glEnable(GL_FRAMEBUFFER_SRGB);
  const bool backdrop = look_.ground && !look_.transparent;
  if (backdrop && has_veils()) {
    target.bind();
    clear(true);
    draw_backdrop(view, false);
    draw_surface(surface, view, {0, 0, target.width(), target.height()});
    target.resolve({0, 0, target.width(), target.height()});
  } else {
    if (target.samples() > 1 && (area.width < target.width() || area.height < target.height())) {
      target.bind_resolved();
      clear(false);
    }
    if (target.samples() == 1 || !area.empty()) {
      target.bind();
      clear(true);
    }
    if (!area.empty()) draw_surface(surface, view, area);
    target.resolve(area);
    if (backdrop) {
      target.bind_resolved();
      draw_backdrop(view, true);
    }
  }
  gpu::check("while rendering");
}

bool RenderPass::has_veils() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const DrawPart& part) { return part.has_alpha; });
}

void RenderPass::draw_surface(const SurfaceBuffers& surface, const View& view, const gpu::Rectangle& area) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(area.x, area.y, area.width, area.height);
  glEnable(GL_DEPTH_TEST);
  if (look_.shadows) glBindTextureUnit(2, shadow_texture_);
  draw_parts(surface_, false, true);
  if (has_veils()) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // colours are premultiplied
    glDepthMask(GL_FALSE);
    draw_parts(surface_, true, true);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
  }
  if (look_.wireframe) {
    lines_.use();
    uniform(lines_, "to_clip", view.view_projection);
    uniform(lines_, "pull", 1e-3F);  // a thousandth of the model: lines of steep triangles stay whole
    uniform(lines_, "flat_colour", glm::vec4(0.02F, 0.02F, 0.025F, 1));
    glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * surface.triangle_count));
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  }
  glDisable(GL_SCISSOR_TEST);
}

void RenderPass::draw_aov(const SurfaceBuffers& surface, const View& view, const gpu::Target& target,
                          Aov aov) {
  if (aov_.empty()) {
    gpu::Defines defines = surface_defines();
    defines.emplace_back("AOV", "1");
    const gpu::Defines kinds = aov_defines();
    defines.insert(defines.end(), kinds.begin(), kinds.end());
    aov_ = make_programs({"render.vert", "render.frag"}, defines);
  }
  glDisable(GL_FRAMEBUFFER_SRGB);
  bind_surface(surface);
  write_scene(view);
  target.bind();
  glClearColor(0, 0, 0, 0);
  glDepthMask(GL_TRUE);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  for (const auto& [features, program] : aov_) {
    program.use();
    uniform(program, "aov", static_cast<int>(aov));
    uniform(program, "view_forward", view.forward);
  }
  draw_parts(aov_, false, false);
  draw_parts(aov_, true, false);
  gpu::check("while rendering an AOV");
}

namespace {
template <typename Texel>
std::vector<Texel> texels(unsigned texture, int size, GLenum format) {
  std::vector<Texel> result(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glGetTextureImage(texture, 0, format, GL_FLOAT, static_cast<GLsizei>(result.size() * sizeof(Texel)),
                    result.data());
  return result;
}
}  // namespace

std::vector<float> RenderPass::shadow_map() const {
  return texels<float>(shadow_texture_, shadow_size, GL_DEPTH_COMPONENT);
}
std::vector<float> RenderPass::map_from_below() const {
  return texels<float>(top_texture_, below_size, GL_DEPTH_COMPONENT);
}
std::vector<glm::vec2> RenderPass::ground_map() const {
  return texels<glm::vec2>(ground_textures_[0], ground_size, GL_RG);
}

}  // namespace plisse::passes
