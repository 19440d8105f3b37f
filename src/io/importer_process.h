// The protocol between the two processes of an isolated import (io/isolated_import.cpp,
// io/importer_process.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/import.h"

namespace plisse::io {

inline constexpr const char* importer_name = "plisse-importer";  // argv[0] of the child
inline constexpr int importer_file = 3;                          // holds the order, then the model
inline constexpr int importer_pipe = 4;                          // messages to the caller

// Precedes its key and its text.
struct ImporterMessage {
  enum Kind : std::uint32_t { reader, warning, error, out_of_memory, done };
  Kind kind = reader;
  std::uint32_t key_size = 0, text_size = 0;
};

struct ImportOrder {
  std::filesystem::path path;
  ImportOptions options;
};

// The order as text and back, for importer_file.
std::string order_text(const std::filesystem::path& path, const ImportOptions& options);
ImportOrder order_of(std::string_view text);  // throws std::exception where the text is invalid

}  // namespace plisse::io
