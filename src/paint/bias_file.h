// Painted wrinkles as files: a PLY with one vector a welded vertex, and a picture in uv.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "io/model.h"
#include "mesh/surface.h"
#include "paint/canvas.h"

namespace plisse::paint {

// vertex: x, y, z of the rest pose (metres, y up), bias_x, bias_y, bias_z (p, docs/passes.md), and where
// there are waves of solved fields wave_x, wave_y, wave_z (∇φ) and phase; face: vertex_indices. Throws
// Error(no_output).
void write_bias_ply(const std::filesystem::path& path, const Surface& surface, const Painting& painting);

// Throws Error(bad_input) where number or positions of vertices differ from the model's, or |p| ≥ 1.
Painting read_bias_ply(const std::filesystem::path& path, const Surface& surface);

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

// The waves of solved fields beside that texture, with its texels at vertices: red and green are ½ + ½cos φ
// and ½ + ½sin φ, φ counted along the p that is read at the same texel; blue is the wavelength λ of the rest
// pose: λ/D = 2^(12 blue/255 − 12), D the diagonal of the rest pose (steps of 3 %); 0: no solved wave. Throws
// as encode_bias.
io::Image encode_waves(const Surface& surface, const RestFrames& rest, const Painting& painting, int size);
// Into a painting that decode_bias gave for the picture `bias`.
void decode_waves(const Surface& surface, const RestFrames& rest, const io::Image& bias,
                  const io::Image& waves, const std::string& name, Painting& painting);
// Of bias.png: bias_waves.png.
std::filesystem::path waves_beside(const std::filesystem::path& bias);

// p of every welded vertex, from the texels of its uv (the mean over its seams); 0 where it has no uv. Throws
// Error(bad_input) for a picture that is not square, or a model without uv. `name` is for messages.
std::vector<glm::dvec3> decode_bias(const Surface& surface, const RestFrames& rest, const io::Image& image,
                                    const std::string& name);

// Reads one or the other, by the file's ending; with a texture the waves beside it, if there are any.
Painting read_bias(const std::filesystem::path& path, const Surface& surface, const RestFrames& rest);

}  // namespace plisse::paint
