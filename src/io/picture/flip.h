// FLIP: the visible difference of two pictures that alternate on a screen (P. Andersson, J. Nilsson, T.
// Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild: "FLIP: A Difference Evaluator for Alternating
// Images", HPG 2020).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "io/model.h"

namespace plisse::io {

// A 0.7 m wide screen of 3840 pixels seen from 0.7 m: the paper's example.
inline constexpr double flip_pixels_per_degree = 67;

struct FlipResult {
  double mean = 0;           // over the pixels of the mask; 0 where the mask is empty
  std::vector<float> error;  // width·height, rows from top to bottom, 0 (looks the same) … 1
};

// Alpha is ignored: composite first. A pixel counts towards the mean where `mask` (width·height
// entries) is not 0; an empty span counts all. Outside the image the border pixels are repeated. Throws
// Error(bad_input) where the sizes of images or mask differ or pixels_per_degree is not positive.
FlipResult flip(const Image& reference, const Image& test, std::span<const std::uint8_t> mask = {},
                double pixels_per_degree = flip_pixels_per_degree);

}  // namespace plisse::io
