// An OpenGL 4.5 core context without a window, through EGL.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace plisse::gpu {

// The driver's names, and how the context was made.
struct Info {
  std::string vendor, renderer, version, path;
  bool software = false;  // rasterises on the CPU: time with a CPU clock, not with timer queries
};

// The current thread's context; the one that was current before is so again when this one ends. Throws
// Error(no_opengl) that lists every path tried, its error and the package that may help.
class Context {
 public:
  // device: index of `list_devices`, −1 for the first that works.
  explicit Context(int device = -1);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  const Info& info() const { return info_; }

 private:
  struct Handles;
  std::unique_ptr<Handles> handles_;
  Info info_;
};

// One line for every EGL device: its index and its own description.
std::vector<std::string> list_devices();

// Throws Error(try_again) with the name of the GL error, if one is pending; `where` names the operation
// before it.
void check(const char* where);

}  // namespace plisse::gpu
