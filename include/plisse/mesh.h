// Meshes in memory, and what all requests have in common: the sink for messages. Everything in plisse is
// metres, y up, right-handed, but for what a file says of itself.
//
// Threads: the functions of plisse may be called from several threads at the same time, each with requests of
// its own.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace plisse {

using Vector2 = std::array<double, 2>;
using Vector3 = std::array<double, 3>;
using Triangle = std::array<std::uint32_t, 3>;  // three vertices, counterclockwise seen from outside

// Takes the messages of one request, each one line of UTF-8 without its end. A request with an empty sink
// says nothing: the library never writes to standard output or standard error of its own accord. Requests
// that run at the same time write to their own sinks only. A sink is called by one thread at a time, though
// not always by the thread that made the request, and never after the request has returned. A warning that
// would repeat for many vertices or frames comes once a request. A sink must not throw.
enum class MessageLevel {
  detail,   // how a solver goes on, which device draws
  notice,   // what a user will want to know
  warning,  // the result may not be what was meant
};
using MessageSink = std::function<void(MessageLevel level, std::string_view text)>;

// A surface at one moment. Vertices are those of the geometry: a seam of uv or a crease does not split them,
// since corners carry what differs there.
struct Mesh {
  std::vector<Vector3> positions;  // one a vertex, metres
  std::vector<Triangle> triangles;
  std::vector<std::array<Vector2, 3>> uv;       // one a corner of each triangle, v upward; or empty
  std::vector<std::array<Vector3, 3>> normals;  // likewise, unit; or empty
  struct Part {
    std::string name, material;
    std::uint32_t first_triangle = 0, triangle_count = 0;
  };
  std::vector<Part> parts;  // one after the other they cover all triangles; or empty: one part without a name
};

struct LoadOptions {
  std::string up;              // the file's axis that points up: "x", "y" or "z"; empty: as the file says
  double metres_per_unit = 0;  // 0: as the file says
  MessageSink messages;
};

// The first frame of a model, in any format that `plisse render` reads; equal positions become one vertex.
// Normals stay empty. The file is read by a child process within limits of time and memory, so that a damaged
// one does no harm: the child is this very program, started anew and ended before its main(). Throws
// Error(bad_input).
Mesh load_mesh(const std::filesystem::path& path, const LoadOptions& options = {});

// By the ending of the name: .ply (binary), .obj or .glb. Where normals are empty those of the smooth surface
// are written. Throws Error(bad_input) where the mesh does not hold together, Error(no_output); the file is
// whole or not there.
void save_mesh(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace plisse
