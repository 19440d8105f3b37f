// How fine the mesh of a fabric has to be, and pattern pieces meshed so (D. Zhang et al., Physics-inspired
// Estimation of Optimal Cloth Mesh Resolution, SIGGRAPH 2025). docs/sizing.md has the method.
#pragma once

#include <plisse/mesh.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace plisse {

struct Stiffness {
  double bending = 0;  // N·m, above 0
  double modulus = 0;  // Young's, N/m², above 0
};

struct Fabric {
  Stiffness weft;  // across the grain
  Stiffness warp;  // along the grain
  double poisson_ratio = 0.3;
};

// A fabric by name ("wine-style"), or "B,E" with or without units, or four numbers: weft, then warp. Throws
// Error(bad_input) with the nearest name.
Fabric find_fabric(std::string_view text);

// The edge length that a fabric asks for where nothing else is done to it, metres. Throws Error(bad_input).
double edge_length(const Stiffness& stiffness);

struct Panel {
  std::string name = "panel";
  std::vector<Vector2> outline;             // closed, the first point not repeated, metres
  std::vector<std::vector<Vector2>> holes;  // likewise
  Fabric fabric;
  double grain = 90;  // degrees from x to the warp
};

struct SizeRequest {
  std::vector<Panel> panels;     // these, or
  std::filesystem::path file;    // a panel file, or a GarmentCode pattern, which needs `fabric`
  std::optional<Fabric> fabric;  // in place of the file's own
  MessageSink messages;
};

struct MeshedPanel {
  std::string name;
  Mesh mesh;                        // in the plane z = 0; uv are panel coordinates, metres
  std::vector<double> edge_length;  // wanted at each vertex, metres
  double edges_within = 0;          // share of edges between half and double of what is wanted there
  double least_angle = 0;           // degrees
};

struct MeshedPanels {
  std::vector<MeshedPanel> panels;
  // Where the file has seams: the panels sewn to one mesh and placed, a part each.
  std::optional<Mesh> garment;
};

// Throws Error(bad_input) with all that is wrong with the panels.
MeshedPanels size_panels(const SizeRequest& request);

}  // namespace plisse
