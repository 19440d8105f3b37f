// The element tree of an FBX file, binary (7.x, both word sizes) or ASCII, as it is written: assimp reads the
// same files but does not hand over all of them. Lists of numbers stay in the file's bytes until they are
// asked for, so that large meshes cost nothing here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace plisse::io {

// A list of numbers as the file has it, perhaps compressed.
struct FbxArray {
  char type = 'd';          // of binary files: f, d, i, l, b, c; 't': ASCII, numbers with commas between
  std::uint64_t count = 0;  // as the file states it
  bool deflated = false;
  std::string_view bytes;
};

using FbxValue = std::variant<std::int64_t, double, std::string_view, FbxArray>;

struct FbxElement {
  std::string_view name;
  std::vector<FbxValue> values;
  std::vector<FbxElement> children;

  const FbxElement* child(std::string_view name) const;  // the first; null where there is none
  // A value as a number or text; 0 or "" where it is missing or of another kind.
  double number(std::size_t value) const;
  std::int64_t integer(std::size_t value) const;
  std::string_view text(std::size_t value) const;
  // The element's list, unpacked: its array, or else all its single numbers. Throws std::runtime_error where
  // it does not hold as many numbers as it states.
  std::vector<double> numbers() const;
  std::vector<std::int64_t> integers() const;
};

class FbxTree {
 public:
  // Throws std::runtime_error, with the reason, where the bytes are no FBX file of version 7 or are damaged.
  explicit FbxTree(std::string bytes);
  FbxTree(const FbxTree&) = delete;  // the elements point into the bytes
  FbxTree& operator=(const FbxTree&) = delete;

  int version() const { return version_; }
  const FbxElement& root() const { return root_; }

 private:
  std::string bytes_;
  FbxElement root_;
  int version_ = 0;
};

}  // namespace plisse::io
