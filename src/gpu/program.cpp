#include "gpu/program.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gpu/shader_source.h"

namespace plisse::gpu {
namespace {

GLenum stage_of(const std::string& file) {
  if (file.ends_with(".comp")) return GL_COMPUTE_SHADER;
  if (file.ends_with(".vert")) return GL_VERTEX_SHADER;
  return GL_FRAGMENT_SHADER;
}

std::string log_of(GLuint id, bool program) {
  GLint length = 0;
  program ? glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length) : glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
  std::string text(static_cast<std::size_t>(std::max(length, 1)), '\0');
  program ? glGetProgramInfoLog(id, length, nullptr, text.data())
          : glGetShaderInfoLog(id, length, nullptr, text.data());
  return text;
}

}  // namespace

Program::Program(const std::vector<std::string>& files, const Defines& defines,
                 const std::string& shader_folder) {
  std::string head = fmt::format("#version 450 core\n#define GROUP_SIZE {}\n", group_size);
  for (const auto& [name, value] : defines) head += fmt::format("#define {} {}\n", name, value);
  head += "#line 1\n";
  id_ = glCreateProgram();
  for (const auto& file : files) {
    const std::string body = shader_source(file, shader_folder);
    const char* texts[] = {head.c_str(), body.c_str()};
    const GLuint shader = glCreateShader(stage_of(file));
    glShaderSource(shader, 2, texts, nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    const std::string words = ok ? "" : log_of(shader, false);
    glAttachShader(id_, shader);
    glDeleteShader(shader);
    if (!ok)
      throw Error(ExitCode::no_opengl, fmt::format("shader {} does not compile here:\n{}", file, words));
  }
  glLinkProgram(id_);
  GLint ok = 0;
  glGetProgramiv(id_, GL_LINK_STATUS, &ok);
  if (!ok)
    throw Error(ExitCode::no_opengl,
                fmt::format("shader {} does not link here:\n{}", files.front(), log_of(id_, true)));
}

Program::~Program() {
  if (id_) glDeleteProgram(id_);
}

void Program::use() const {
  glUseProgram(id_);
}

int Program::uniform(const char* name) const {
  return glGetUniformLocation(id_, name);
}

void dispatch(const Program& program, std::size_t count) {
  if (count == 0) return;
  program.use();
  const std::size_t groups = (count + group_size - 1) / group_size;
  const std::size_t columns = std::min<std::size_t>(groups, 32768);
  glDispatchCompute(static_cast<GLuint>(columns), static_cast<GLuint>((groups + columns - 1) / columns), 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

}  // namespace plisse::gpu
