// A mesh made in memory goes to a file and comes back.
#include <plisse/mesh.h>

#include <iostream>

int main() {
  plisse::Mesh square;
  square.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  square.triangles = {{0, 1, 2}, {0, 2, 3}};
  square.uv = {{{{0, 0}, {1, 0}, {1, 1}}}, {{{0, 0}, {1, 1}, {0, 1}}}};
  plisse::save_mesh("square.ply", square);

  plisse::LoadOptions options;
  options.messages = [](plisse::MessageLevel, std::string_view text) { std::cout << text << '\n'; };
  const plisse::Mesh read = plisse::load_mesh("square.ply", options);
  std::cout << read.positions.size() << " vertices, " << read.triangles.size() << " triangles\n";
  return read.positions == square.positions && read.triangles == square.triangles && read.uv == square.uv ? 0
                                                                                                          : 1;
}
