# Writes OUTPUT, a C++ file that holds every file of FILES (relative to ROOT) as text: shaders stay files while
# they are written and travel inside the binary afterwards. Long files are split: a string literal has a limit.
set(text "// Made by tools/cmake/embed.cmake from shaders/.\n#include \"gpu/shader_source.h\"\n\nnamespace plisse::gpu {\n")
string(APPEND text "const std::vector<EmbeddedShader>& embedded_shaders() {\n  static const std::vector<EmbeddedShader> files = {\n")
foreach(file ${FILES})
  file(READ ${ROOT}/${file} content)
  string(REPLACE "\n" "\n)shader\"\nR\"shader(" content "${content}")
  string(APPEND text "    {\"${file}\", R\"shader(${content})shader\"},\n")
endforeach()
string(APPEND text "  };\n  return files;\n}\n}  // namespace plisse::gpu\n")
file(WRITE ${OUTPUT} "${text}")
