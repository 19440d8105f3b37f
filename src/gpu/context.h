// An OpenGL 4.5 core context without a window, through EGL. Knows nothing of wrinkles.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace plisse::gpu {

// What the driver calls itself, and how the context was made.
struct Info {
  std::string vendor, renderer, version, path;
  bool software = false;  // rasterises on the CPU: time with a CPU clock, not with timer queries
};

// The current thread's context; one at a time. Throws Error(no_opengl) that lists every path tried, what it
// said and which package helps.
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

// One line for every EGL device: index, and what it says of itself.
std::vector<std::string> list_devices();

// Throws Error(try_again) with the name of the GL error, if one is pending; `where` says after what.
void check(const char* where);

}  // namespace plisse::gpu
