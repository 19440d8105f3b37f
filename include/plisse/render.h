// What plisse makes of a scene: pictures whose cloth wrinkles (J. Loviscach, Wrinkling Coarse Meshes on the
// GPU, 2006), geometry, maps, painted wrinkles; and the check of its shaders. docs/passes.md has the method.
//
// What is made of a frame goes to a callback as soon as it is there, in the order of the frames, from the
// thread that made the request. What a callback throws ends the request and comes out of it. Frames are
// counted from 1.
//
// All but paint_wrinkles draw with OpenGL, in a context of their own. Callbacks find it current and must
// leave it so. What the thread had current through EGL is current again afterwards; a context of GLX is not,
// so call from a thread without one.
//
// All throw Error: bad_input, with all that is wrong with a scene; no_opengl, where nothing can draw;
// no_output and try_again (memory, a lost GPU).
#pragma once

#include <plisse/wrinkle.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace plisse {

// One of `file`, `text` and `frames`. A text may stand beside `frames` for all other keys: its [model] has no
// path then.
struct Scene {
  std::filesystem::path file;     // a scene file (docs/scene.md), a panel file, or a model
  std::string text;               // a scene file's text
  std::filesystem::path folder;   // of the text: paths in it are relative to this
  std::vector<Mesh> frames;       // a surface in motion; all have the triangles, uv and parts of the first
  double frames_per_second = 24;  // of `frames`
  // Solved waves, in place of the scene's [bias]: one field, of the rest pose, or one a frame.
  std::vector<WrinkleField> fields;
  // Options of `plisse render` over the scene's keys, in order: {"--size", "640x480"}, {"--frames", "1-48"}.
  std::vector<std::pair<std::string, std::string>> options;
};

struct DrawOptions {
  // Of waves as geometry: how often edges are halved, 0 … 8; none: as the waves need it.
  std::optional<int> levels;
  // Likewise, and of maps: a body that waves keep out of, a part of the model or a file; empty: none.
  std::string outside;
  int device = -1;  // as `plisse render --list-devices` counts them; −1: the first that works
};

struct Picture {
  int width = 0, height = 0;       // pixels
  std::vector<std::uint8_t> rgba;  // four bytes a pixel: sRGB, straight alpha; rows from top to bottom
};

struct RenderRequest {
  Scene scene;
  bool displace = false;  // waves as geometry in place of shading
  DrawOptions draw;
  std::function<void(int frame, const Picture&)> on_picture;  // none: PNG files, where the scene says
  MessageSink messages;
};

struct RenderReport {
  std::string device;  // "renderer, vendor, OpenGL version"
  std::size_t vertices = 0, triangles = 0;
  double wavelength = 0;           // metres
  std::vector<int> frames;         // those that were drawn
  std::vector<std::string> files;  // where their pictures were written
};

// Where some frames could not be drawn or written, the others are complete: Error(some_frames).
RenderReport render(const RenderRequest& request);

struct VerifyReport {
  bool ok = false;
  struct Pass {
    std::string name;
    double largest = 0, tolerance = 0;  // difference, in `unit`
    std::string unit;
    bool ok = false;
  };
  std::vector<Pass> passes;           // skin, crush, relax, render, and parts of them
  std::vector<std::string> failures;  // one sentence each
};

// Every pass of the shaders against a reference in double precision, over the frames of `request`, whose
// pictures go nowhere.
VerifyReport verify(const RenderRequest& request);

struct ExportRequest {
  Scene scene;
  DrawOptions draw;
  std::function<void(int frame, const Mesh&)> on_mesh;  // needed
  MessageSink messages;
};

// The surface of each frame with its waves as geometry. Returns how often edges were halved.
int export_meshes(const ExportRequest& request);

// The waves of one frame over the model's uv, for the coarse mesh to wear; rows from top to bottom. The maps
// cover the square of uv from `corner` to `corner` + `side`: 0 … 1 but where uv leave it.
struct BakedMaps {
  int size = 0;  // texels a side
  Vector2 corner{};
  int side = 1;
  std::vector<float> height;                  // one a texel, along the posed mesh's normal, metres
  std::vector<std::array<float, 3>> normals;  // one a texel, in the mesh's MikkTSpace basis, unit, y upward
};

struct BakeRequest {
  Scene scene;
  int size = 2048;  // texels a side, 16 … 16384
  DrawOptions draw;
  std::function<void(int frame, const BakedMaps&)> on_maps;  // needed
  MessageSink messages;
};

void bake(const BakeRequest& request);

// Strokes of a paint file (docs/paint.md) on the rest pose of the scene that it names.
struct PaintRequest {
  std::filesystem::path file;    // this, or
  std::string text;              // a paint file's text
  std::filesystem::path folder;  // of the text: paths in it are relative to this
  MessageSink messages;
};

struct PaintedWrinkles {
  std::vector<Vector3> positions;  // of the rest pose, metres
  std::vector<Vector3> vectors;    // one a vertex: along which cloth is gathered, and how much, 0 … 1
};

PaintedWrinkles paint_wrinkles(const PaintRequest& request);

}  // namespace plisse
