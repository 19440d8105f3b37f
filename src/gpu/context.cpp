#include "gpu/context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <array>
#include <functional>

#include "base/error.h"
#include "base/log.h"

namespace plisse::gpu {
namespace {

const char* egl_error_text(EGLint code) {
  switch (code) {
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED (no driver could be loaded; install libgl1-mesa-dri, or your GPU's driver)";
    case EGL_BAD_ACCESS:
      return "EGL_BAD_ACCESS (the device is not yours to open; join the groups render and video)";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC (out of memory)";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_CONTEXT:
      return "EGL_BAD_CONTEXT";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH (the driver has no OpenGL 4.5 core)";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    case EGL_SUCCESS:
      return "nothing";
    default:
      return "an unknown error";
  }
}

// epoxy ends the process when these libraries are missing, so they are opened before its first call. They
// stay open, since epoxy uses them next.
void require_library(const char* purpose, std::initializer_list<const char*> names, const char* package) {
  for (const char* name : names) {
    if (dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr) return;
  }
  throw Error(ExitCode::no_opengl,
              fmt::format("no usable OpenGL: {} ({}) is not installed; install the package {}",
                          *names.begin(), purpose, package));
}

void require_libraries() {
  require_library("EGL", {"libEGL.so.1"}, "libegl1");
  require_library("OpenGL", {"libOpenGL.so.0", "libGL.so.1"}, "libopengl0");
}

std::vector<EGLDeviceEXT> query_devices(std::string& problem) {
  if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration") &&
      !epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_base")) {
    problem = "this EGL cannot list devices (EGL_EXT_device_enumeration is missing)";
    return {};
  }
  EGLint count = 0;
  if (!eglQueryDevicesEXT(0, nullptr, &count) || count == 0) {
    problem = fmt::format("EGL lists no devices: {}", egl_error_text(eglGetError()));
    return {};
  }
  std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
  eglQueryDevicesEXT(count, devices.data(), &count);
  devices.resize(static_cast<std::size_t>(count));
  return devices;
}

std::string device_text(EGLDeviceEXT device) {
  const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
  const std::string all = extensions ? extensions : "";
  if (all.find("EGL_MESA_device_software") != std::string::npos) return "software (Mesa)";
  if (all.find("EGL_EXT_device_drm") != std::string::npos) {
    if (const char* file = eglQueryDeviceStringEXT(device, EGL_DRM_DEVICE_FILE_EXT)) return file;
  }
  if (all.find("EGL_NV_device_cuda") != std::string::npos) return "NVIDIA";
  return all.empty() ? "unnamed" : all;
}

bool is_software(const std::string& renderer) {
  for (const char* name : {"llvmpipe", "softpipe", "SWR", "Software"}) {
    if (renderer.find(name) != std::string::npos) return true;
  }
  return false;
}

}  // namespace

// The display is never terminated. EGL has one of each device in a process, shared with the program that uses
// the library and with our contexts of other threads; eglTerminate would end it for all of them, since it
// does not count who initialised it (EGL_KHR_display_reference, which does, is missing in Mesa). What stays
// is a driver that is ready for the next context.
struct Context::Handles {
  // What was current on this thread, which is the host's, or that of another context of ours.
  EGLenum api_before = eglQueryAPI();
  EGLDisplay display_before = eglGetCurrentDisplay();
  EGLSurface draw_before = eglGetCurrentSurface(EGL_DRAW), read_before = eglGetCurrentSurface(EGL_READ);
  EGLContext context_before = eglGetCurrentContext();
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  ~Handles() {
    if (context != EGL_NO_CONTEXT) eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglBindAPI(api_before);
    if (context_before != EGL_NO_CONTEXT)
      eglMakeCurrent(display_before, draw_before, read_before, context_before);
    if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
  }

  // Empty if the context was made and is current, otherwise the error.
  std::string open(EGLDisplay candidate) {
    if (candidate == EGL_NO_DISPLAY) return fmt::format("no display: {}", egl_error_text(eglGetError()));
    EGLint major = 0, minor = 0;
    if (!eglInitialize(candidate, &major, &minor))
      return fmt::format("eglInitialize: {}", egl_error_text(eglGetError()));
    display = candidate;
    std::string problem;
    if (!eglBindAPI(EGL_OPENGL_API)) {
      problem = fmt::format("eglBindAPI(OpenGL): {}", egl_error_text(eglGetError()));
    } else if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) {
      problem = "no EGL_KHR_surfaceless_context";
    } else {
      EGLConfig config = EGL_NO_CONFIG_KHR;
      EGLint configs = 1;
      if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
        const std::array<EGLint, 3> wanted{EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        if (!eglChooseConfig(display, wanted.data(), &config, 1, &configs)) configs = 0;
      }
      const std::array<EGLint, 7> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                             4,
                                             EGL_CONTEXT_MINOR_VERSION,
                                             5,
                                             EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                             EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                             EGL_NONE};
      context =
          configs > 0 ? eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data()) : EGL_NO_CONTEXT;
      if (context == EGL_NO_CONTEXT) {
        problem = fmt::format("an OpenGL 4.5 core context: {}", egl_error_text(eglGetError()));
      } else if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        problem = fmt::format("eglMakeCurrent: {}", egl_error_text(eglGetError()));
      }
    }
    if (!problem.empty()) {
      if (context != EGL_NO_CONTEXT) eglDestroyContext(display, context);
      display = EGL_NO_DISPLAY;
      context = EGL_NO_CONTEXT;
    }
    return problem;
  }
};

Context::Context(int device) {
  require_libraries();
  handles_ = std::make_unique<Handles>();
  std::string tried;
  const auto attempt = [&](const std::string& path, const std::function<EGLDisplay()>& make_display) {
    const std::string problem = handles_->open(make_display());
    if (problem.empty()) {
      info_.path = path;
      return true;
    }
    tried += fmt::format("\n  {}: {}", path, problem);
    log::info(fmt::format("{}: {}", path, problem));
    return false;
  };

  std::string problem;
  const auto devices = query_devices(problem);
  if (devices.empty()) tried += "\n  EGL devices: " + problem;
  if (device >= 0 && static_cast<std::size_t>(device) >= devices.size()) {
    throw Error(ExitCode::bad_input,
                fmt::format("--device {}: there are {} EGL devices, counted from 0 (see --list-devices)",
                            device, devices.size()));
  }
  bool open = false;
  for (std::size_t i = 0; i < devices.size() && !open; ++i) {
    if (device >= 0 && static_cast<std::size_t>(device) != i) continue;
    open = attempt(fmt::format("EGL device {} ({})", i, device_text(devices[i])),
                   [&] { return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr); });
  }
  if (!open && device < 0 && epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
    open = attempt("EGL surfaceless (Mesa)", [] {
      return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    });
  }
  if (!open) {
    throw Error(ExitCode::no_opengl, "no usable OpenGL 4.5; tried:" + tried +
                                         "\nOn Debian without a GPU, install libegl1 and libgl1-mesa-dri.");
  }
  const auto text = [](GLenum name) {
    const auto* value = reinterpret_cast<const char*>(glGetString(name));
    return std::string(value ? value : "");
  };
  info_.vendor = text(GL_VENDOR);
  info_.renderer = text(GL_RENDERER);
  info_.version = text(GL_VERSION);
  info_.software = is_software(info_.renderer);
  log::info(fmt::format("{}: {}, {}, OpenGL {}", info_.path, info_.vendor, info_.renderer, info_.version));
}

Context::~Context() = default;

std::vector<std::string> list_devices() {
  require_libraries();
  std::string problem;
  std::vector<std::string> lines;
  const auto devices = query_devices(problem);
  for (std::size_t i = 0; i < devices.size(); ++i)
    lines.push_back(fmt::format("{}: {}", i, device_text(devices[i])));
  if (lines.empty()) throw Error(ExitCode::no_opengl, "no EGL device: " + problem);
  return lines;
}

void check(const char* where) {
  const GLenum code = glGetError();
  if (code == GL_NO_ERROR) return;
  const char* name = code == GL_OUT_OF_MEMORY       ? "out of memory"
                     : code == GL_CONTEXT_LOST      ? "context lost"
                     : code == GL_INVALID_VALUE     ? "invalid value"
                     : code == GL_INVALID_ENUM      ? "invalid enum"
                     : code == GL_INVALID_OPERATION ? "invalid operation"
                                                    : "error";
  throw Error(ExitCode::try_again, fmt::format("OpenGL: {} (0x{:x}) {}", name, code, where));
}

}  // namespace plisse::gpu
