// The checked contents of a paint file (docs/paint.md): the strokes that paint wrinkles on the rest pose of a
// model (Loviscach 2006, section 7). Lengths are metres, angles degrees.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace plisse::config {

// The direction in which cloth is gathered; folds are perpendicular to it.
struct PaintDirection {
  enum class Kind {
    across,  // at right angles to the stroke: its fold runs along it
    along,
    angle,   // counterclockwise from the picture's right (screen) or from growing u (all others)
    vector,  // of the rest pose's space
    random,
  };
  Kind kind = Kind::across;
  double degrees = 0;
  glm::dvec3 vector{0};
};

struct PaintStroke {
  enum class Kind { screen, surface, uv, image, colours, painted, field, random, fill };
  enum class Mode { paint, erase, smooth };
  enum class Falloff { smooth, linear, flat };

  std::string place;  // "file:line:column", for messages
  Kind kind = Kind::surface;
  Mode mode = Mode::paint;
  double strength = 0.45;  // |p|: the cloth is shortened by its square
  PaintDirection direction;
  std::vector<std::string> only, exclude;  // meshes or materials

  // screen: pixels, x to the right, y down, z unused; surface: metres of the rest pose; uv: u and v, z unused
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> vertices;  // surface: in place of points
  double radius = 0;                    // pixels, metres, or units of uv
  Falloff falloff = Falloff::smooth;

  int frame = 1;               // screen: of which the points are seen
  std::string camera;          // screen: as --camera; empty: the scene's
  int width = 0, height = 0;   // screen: of the picture; 0: the scene's
  std::filesystem::path file;  // image, colours, painted, field
  std::string up = "y";        // colours: the file's axis that points up
  std::uint32_t seed = 1;      // random
  double density = 0;          // random: wrinkles per square metre
  double length = 0;           // random: of each, metres
  int rounds = 1;              // smooth
};

struct PaintSettings {
  std::filesystem::path file;
  std::filesystem::path scene;  // a scene or a model
  int texture_size = 1024;      // of the uv texture
  int preview_frame = 1;        // 0: no preview
  std::vector<PaintStroke> strokes;
};

}  // namespace plisse::config
