// How fine a fabric has to be meshed, and a square of it meshed so.
#include <plisse/size.h>

#include <iostream>

int main() {
  plisse::SizeRequest request;
  plisse::Panel& panel = request.panels.emplace_back();
  panel.name = "square";
  panel.outline = {{0, 0}, {0.2, 0}, {0.2, 0.2}, {0, 0.2}};
  panel.fabric = plisse::find_fabric("2e-6 N·m, 0.3 MPa");
  const plisse::MeshedPanel square = plisse::size_panels(request).panels.at(0);
  std::cout << "edges of " << 1000 * plisse::edge_length(panel.fabric.weft)
            << " mm: " << square.mesh.positions.size() << " vertices\n";
  return square.edges_within > 0.99 && square.least_angle > 25 ? 0 : 1;  // what docs/sizing.md promises
}
