// A linked GLSL program.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace plisse::gpu {

using Defines = std::vector<std::pair<std::string, std::string>>;

class Program {
 public:
  Program() = default;
  // Files of shaders/ by their ending: one .comp, or .vert and .frag. Defines follow the #version line that
  // this class writes. Throws Error(no_opengl) with the compiler's message.
  Program(const std::vector<std::string>& files, const Defines& defines = {},
          const std::string& shader_folder = "");
  ~Program();
  Program(Program&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Program& operator=(Program&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  unsigned id() const { return id_; }
  void use() const;
  int uniform(const char* name) const;  // −1 if the linker dropped it

 private:
  unsigned id_ = 0;
};

// Runs a compute program over `count` items in groups of `group_size`, in two dimensions where there are more
// than 65,535 groups, for which a driver may do nothing. Shaders use `item_index()` of common/items.glsl.
inline constexpr int group_size = 64;
void dispatch(const Program& program, std::size_t count);

}  // namespace plisse::gpu
