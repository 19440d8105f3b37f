#include "gpu/target.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "gpu/context.h"

namespace plisse::gpu {

Target::Target(int width, int height, int samples, Format format)
    : width_(width), height_(height), samples_(samples) {
  const GLenum colour_format = format == Format::srgb8 ? GL_SRGB8_ALPHA8 : GL_RGBA32F;
  const auto storage = [&](unsigned& id, GLenum internal, int count) {
    glCreateRenderbuffers(1, &id);
    if (count > 1) {
      glNamedRenderbufferStorageMultisample(id, count, internal, width, height);
    } else {
      glNamedRenderbufferStorage(id, internal, width, height);
    }
  };
  const auto complete = [&](unsigned framebuffer) {
    const GLenum status = glCheckNamedFramebufferStatus(framebuffer, GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
      throw Error(ExitCode::try_again,
                  fmt::format("OpenGL: a {}×{} picture with {} samples cannot be made here (0x{:x}); "
                              "try a smaller --size or --samples 1",
                              width, height, samples, status));
    }
  };
  storage(colour_, colour_format, samples);
  storage(depth_, GL_DEPTH_COMPONENT32F, samples);
  glCreateFramebuffers(1, &draw_);
  glNamedFramebufferRenderbuffer(draw_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
  glNamedFramebufferRenderbuffer(draw_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
  complete(draw_);
  if (samples > 1) {
    storage(resolved_, colour_format, 1);
    glCreateFramebuffers(1, &read_);
    glNamedFramebufferRenderbuffer(read_, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, resolved_);
    complete(read_);
  } else {
    read_ = draw_;
  }
  check("while making a picture");
}

Target::~Target() {
  if (!draw_) return;
  if (read_ != draw_) glDeleteFramebuffers(1, &read_);
  glDeleteFramebuffers(1, &draw_);
  const unsigned buffers[] = {colour_, depth_, resolved_};
  glDeleteRenderbuffers(3, buffers);
}

Target& Target::operator=(Target&& other) noexcept {
  std::swap(draw_, other.draw_);
  std::swap(read_, other.read_);
  std::swap(colour_, other.colour_);
  std::swap(depth_, other.depth_);
  std::swap(resolved_, other.resolved_);
  std::swap(width_, other.width_);
  std::swap(height_, other.height_);
  std::swap(samples_, other.samples_);
  return *this;
}

void Target::bind() const {
  glBindFramebuffer(GL_FRAMEBUFFER, draw_);
  glViewport(0, 0, width_, height_);
}

void Target::bind_resolved() const {
  glBindFramebuffer(GL_FRAMEBUFFER, read_);
  glViewport(0, 0, width_, height_);
}

void Target::resolve(const Rectangle& area) const {
  if (read_ == draw_ || area.empty()) return;
  glBlitNamedFramebuffer(draw_, read_, area.x, area.y, area.x + area.width, area.y + area.height, area.x,
                         area.y, area.x + area.width, area.y + area.height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

namespace {
template <typename Item>
std::vector<Item> read_flipped(unsigned framebuffer, int width, int height, GLenum type) {
  const std::size_t row = static_cast<std::size_t>(width) * 4;
  std::vector<Item> pixels(row * static_cast<std::size_t>(height));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, type, pixels.data());
  check("while reading a picture");
  for (std::size_t top = 0, bottom = static_cast<std::size_t>(height) - 1; top < bottom; ++top, --bottom) {
    std::swap_ranges(pixels.begin() + static_cast<std::ptrdiff_t>(top * row),
                     pixels.begin() + static_cast<std::ptrdiff_t>((top + 1) * row),
                     pixels.begin() + static_cast<std::ptrdiff_t>(bottom * row));
  }
  return pixels;
}
}  // namespace

std::vector<std::uint8_t> Target::read_rgba8() const {
  return read_flipped<std::uint8_t>(read_, width_, height_, GL_UNSIGNED_BYTE);
}

std::vector<float> Target::read_rgba32f() const {
  return read_flipped<float>(read_, width_, height_, GL_FLOAT);
}

}  // namespace plisse::gpu
