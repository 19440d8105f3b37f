// plisse size: panel file → for each panel domain, map, samples, mesh → files and figures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/panel_file.h"
#include "sizing/garment.h"

namespace plisse::cloth {

struct SizeRequest {
  std::filesystem::path panels;                         // the panel file, or a GarmentCode pattern
  std::filesystem::path folder;                         // where the files go
  std::optional<sizing::Fabric> fabric = std::nullopt;  // of a GarmentCode pattern
};

struct SizeReport {
  struct Feature {
    std::string name, rule;
    double resolution = 0;  // m; the finer of weft and warp
  };
  struct Panel {
    std::string name;
    glm::dvec2 fabric_resolution{0};  // (weft, warp), m
    std::vector<Feature> features;
    std::size_t vertices = 0, triangles = 0;
    double uniform_vertices = 0;  // with the finest resolution everywhere
    double finest = 0;            // m
    sizing::MeshQuality quality;
    sizing::MeshTimes seconds;
  };
  std::vector<Panel> panels;
  struct Garment {  // where panels are sewn
    std::size_t vertices = 0, triangles = 0;
    std::vector<sizing::SizedGarment::Join> seams;
  };
  std::optional<Garment> garment;
  std::vector<std::filesystem::path> files;
};

// The panels of a file meshed, sewn where it has seams; without seams nothing but `made` and `panels` is
// filled in. Says what the mesher warns of. Throws Error(bad_input).
sizing::SizedGarment mesh_panels(const config::PanelFile& file);

// Writes for every panel NAME.obj, NAME.ply, NAME_map.png and NAME_mesh.png, and where there are seams
// garment.obj: the panels sewn to one mesh, placed, with panel coordinates as uv. Throws Error.
SizeReport size_panels(const SizeRequest& request);

}  // namespace plisse::cloth
