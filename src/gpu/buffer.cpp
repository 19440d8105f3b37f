#include "gpu/buffer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "gpu/context.h"

namespace plisse::gpu {

Buffer::Buffer(std::size_t bytes, const void* data) : bytes_(bytes) {
  glCreateBuffers(1, &id_);
  // OpenGL does not allow a buffer of 0 bytes, but a mesh may have no neighbours.
  const GLsizeiptr size = static_cast<GLsizeiptr>(bytes ? bytes : 16);
  glNamedBufferStorage(id_, size, bytes ? data : nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (!data || !bytes) glClearNamedBufferData(id_, GL_R8, GL_RED, GL_UNSIGNED_BYTE, nullptr);
  check("while making a buffer");
}

Buffer::~Buffer() {
  if (items_) glDeleteTextures(1, &items_);
  if (id_) glDeleteBuffers(1, &id_);
}

void Buffer::bind_items(int unit, Item item) const {
  if (!items_) {
    struct Kind {
      GLenum format;
      std::size_t bytes;
    };
    constexpr Kind kinds[] = {
        {GL_RGBA32F, 16}, {GL_RG32F, 8}, {GL_RGBA32UI, 16}, {GL_RG32UI, 8}, {GL_R32UI, 4}};
    const Kind kind = kinds[static_cast<int>(item)];
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
    if (bytes_ / kind.bytes > static_cast<std::size_t>(most)) {
      throw Error(ExitCode::bad_input,
                  fmt::format("the model is too large for this OpenGL driver: it reads lists of at most "
                              "{} items, and one has {}",
                              most, bytes_ / kind.bytes));
    }
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &items_);
    glTextureBuffer(items_, kind.format, id_);
  }
  glBindTextureUnit(static_cast<GLuint>(unit), items_);
}

void Buffer::bind_storage(int binding) const {
  if (!fits_storage_) {  // checked once for each buffer: another device may have another limit
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    if (bytes_ > static_cast<std::size_t>(most)) {
      throw Error(
          ExitCode::bad_input,
          fmt::format(
              "this is too large for this OpenGL driver: shaders write lists of at most {} bytes, and one "
              "has {}; with --displace, fewer --levels need less",
              most, bytes_));
    }
    fits_storage_ = true;
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id_);
}
void Buffer::bind_uniform(int binding) const {
  glBindBufferBase(GL_UNIFORM_BUFFER, binding, id_);
}

void Buffer::write(const void* data, std::size_t bytes, std::size_t offset) {
  if (bytes) glNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::read(void* data, std::size_t bytes, std::size_t offset) const {
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (bytes)
    glGetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

}  // namespace plisse::gpu
