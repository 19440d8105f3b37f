// A Model as bytes and back, for the way between two processes of one program (io/isolated_import.h): nothing
// is stored on disk, so numbers have this machine's byte order. A vertex cache is not included; readers of
// files have none.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "io/model.h"

namespace plisse::io {

std::size_t byte_count(const Model& model);
// bytes.size() == byte_count(model).
void write_bytes(const Model& model, std::span<std::byte> bytes);
// Checks everything: throws std::runtime_error where counts exceed the data, an enumeration has no such value
// or bytes are left over. `validate` checks the meaning of the numbers.
Model model_from_bytes(std::span<const std::byte> bytes);

}  // namespace plisse::io
