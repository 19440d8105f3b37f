// Limits for one model file. Damaged and hostile files may contain counts of billions; with a limit they give
// an error that names the limit, and do not fill the machine's memory. The keys of [limits] in a scene
// (src/config/settings.h) set them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace plisse {

struct Limits {
  double factor = 1;                 // on all below
  int file_mib = 4096;               // size of one file, MiB
  int memory_mib = 8192;             // address space while a file is read, MiB
  int seconds = 120;                 // wall clock while a file is read
  int vertices = 20'000'000;         // of all meshes, as the file splits them
  int triangles = 20'000'000;        // of all meshes
  int bones = 100'000;               // of all skins
  int keys = 50'000'000;             // of all channels of all clips
  int texture_pixels = 300'000'000;  // of all textures: just above one of 16384 × 16384

  std::uint64_t with_factor(int limit) const;
};

// "30000000 vertices are more than the limit of 20000000; …" and which key raises it, where `found` is more
// than limits.*limit times the factor; else empty. `key` is the member's name, which is the scene's key too.
std::string over_limit(const Limits& limits, int Limits::*limit, std::string_view key, std::uint64_t found,
                       std::string_view what);

}  // namespace plisse
