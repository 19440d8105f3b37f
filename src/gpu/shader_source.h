// The shaders' text: embedded at build time, or read from a folder at run time.
#pragma once

#include <string>
#include <vector>

namespace plisse::gpu {

struct EmbeddedShader {
  std::string name;  // relative to shaders/, "common/wave.glsl"
  std::string text;
};
const std::vector<EmbeddedShader>& embedded_shaders();

// A file's text with its `#include "…"` lines (relative to shaders/) replaced by the files, each file once.
// `folder` overrides the embedded text; empty: embedded. Throws Error(bad_input) naming the file that is
// missing.
std::string shader_source(const std::string& name, const std::string& folder = "");

}  // namespace plisse::gpu
