// A Model as bytes and back, for the way between two processes of one program (io/isolated_import.h): nothing
// is kept on disk, so numbers lie as this machine has them. A vertex cache does not travel; the reader of
// files has none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "io/model.h"

namespace plisse::io {

std::size_t byte_count(const Model& model);
// bytes.size() == byte_count(model).
void write_bytes(const Model& model, std::span<std::byte> bytes);
// Trusts nothing: throws std::runtime_error where counts run past the end, an enumeration has no such value
// or bytes are left over. What the numbers mean is `validate`'s to check.
Model model_from_bytes(std::span<const std::byte> bytes);

}  // namespace plisse::io
