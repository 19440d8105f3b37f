// Painted wrinkles as files: a PLY with one vector a welded vertex, and a picture in uv.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "io/model.h"
#include "mesh/surface.h"

namespace plisse::paint {

// vertex: x, y, z of the rest pose (metres, y up), bias_x, bias_y, bias_z (p, docs/passes.md); face:
// vertex_indices. Throws Error(no_output).
void write_bias_ply(const std::filesystem::path& path, const Surface& surface,
                    const std::vector<glm::dvec3>& bias);

// p of every welded vertex. Throws Error(bad_input) where number or positions of vertices differ from the
// model's, or |p| ≥ 1.
std::vector<glm::dvec3> read_bias_ply(const std::filesystem::path& path, const Surface& surface);

// The uv texture: `size`² texels that are data, not colour. Red and green are ½ + ½cos 2θ and ½ + ½sin 2θ, θ
// the angle of p from growing u toward growing v in the tangent plane (doubled because p and −p are the same,
// and so that texels may be averaged); blue is |p|. The texel at a vertex has exactly its p; texels in
// between are interpolated; islands are widened by eight texels, so that filters do not reach the background
// (0.5, 0.5, 0). Where uv leaves 0…1 the texture covers the square of whole tiles that holds it, as a baked
// map does (mesh/uv_raster.h). A vertex whose texel belongs to another one already, where islands overlap or
// texels are too large, has the nearest free one, which the model and the size alone decide: so it is read
// back exactly. `moved`: how many have. Throws Error(bad_input) where there is no uv, it reaches over more
// than most_tiles, or there are fewer texels than vertices.
io::Image encode_bias(const Surface& surface, const RestFrames& rest, const std::vector<glm::dvec3>& bias,
                      int size, std::size_t* moved = nullptr);

// p of every welded vertex, from the texels of its uv (the mean over its seams); 0 where it has no uv. Throws
// Error(bad_input) for a picture that is not square, or a model without uv. `name` is for messages.
std::vector<glm::dvec3> decode_bias(const Surface& surface, const RestFrames& rest, const io::Image& image,
                                    const std::string& name);

// Reads one or the other, by the file's ending.
std::vector<glm::dvec3> read_bias(const std::filesystem::path& path, const Surface& surface,
                                  const RestFrames& rest);

}  // namespace plisse::paint
