// Typed access to a glTF's JSON (see import_gltf_json.h).
#include "io/gltf/import_gltf_json.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace plisse::io {

GltfValue::GltfValue(const std::filesystem::path& file, const nlohmann::json* json, std::string where)
    : file_(&file), json_(json != nullptr && json->is_null() ? nullptr : json), where_(std::move(where)) {}

void GltfValue::fail(const std::string& what) const {
  throw Error(ExitCode::bad_input, where_.empty() ? fmt::format("{}: {}", file_->string(), what)
                                                  : fmt::format("{}: {}: {}", file_->string(), where_, what));
}

GltfValue GltfValue::operator[](const std::string& key) const {
  if (json_ == nullptr) return {*file_, nullptr, where_ + "." + key};
  if (!json_->is_object()) fail(fmt::format("is a {}, must be an object", json_->type_name()));
  const auto found = json_->find(key);
  return {*file_, found == json_->end() ? nullptr : &*found, where_.empty() ? key : where_ + "." + key};
}

std::vector<std::pair<std::string, GltfValue>> GltfValue::members() const {
  std::vector<std::pair<std::string, GltfValue>> result;
  if (json_ == nullptr) return result;
  if (!json_->is_object()) fail(fmt::format("is a {}, must be an object", json_->type_name()));
  for (const auto& [key, value] : json_->items())
    result.emplace_back(key, GltfValue(*file_, &value, where_ + "." + key));
  return result;
}

std::size_t GltfValue::size() const {
  if (json_ == nullptr) return 0;
  if (!json_->is_array()) fail(fmt::format("is a {}, must be an array", json_->type_name()));
  return json_->size();
}

GltfValue GltfValue::at(std::size_t index) const {
  if (index >= size()) fail(fmt::format("has {} entries; entry {} is asked for", size(), index));
  return {*file_, &(*json_)[index], fmt::format("{}[{}]", where_, index)};
}

std::string GltfValue::text(const std::string& fallback) const {
  if (json_ == nullptr) return fallback;
  if (!json_->is_string()) fail(fmt::format("is a {}, must be a string", json_->type_name()));
  return json_->get<std::string>();
}

bool GltfValue::truth(bool fallback) const {
  if (json_ == nullptr) return fallback;
  if (!json_->is_boolean()) fail(fmt::format("is a {}, must be true or false", json_->type_name()));
  return json_->get<bool>();
}

double GltfValue::number() const {
  if (json_ == nullptr) fail("is missing");
  if (!json_->is_number()) fail(fmt::format("is a {}, must be a number", json_->type_name()));
  const auto value = json_->get<double>();
  if (!std::isfinite(value)) fail("is not finite");
  return value;
}

std::uint64_t GltfValue::count() const {
  const double value = number();
  // Above 2^53 doubles skip whole numbers, and nothing has so many parts.
  if (!(value >= 0 && value <= 9007199254740992.0) || value != std::floor(value))
    fail(fmt::format("is {}, must be a whole number from 0", value));
  return static_cast<std::uint64_t>(value);
}

std::size_t GltfValue::index(const GltfValue& list) const {
  const std::uint64_t value = count();
  if (value >= list.size()) fail(fmt::format("is {}, of {} {}", value, list.size(), list.where_));
  return static_cast<std::size_t>(value);
}

std::vector<double> GltfValue::numbers(std::size_t size, const std::vector<double>& fallback) const {
  if (json_ == nullptr) return fallback;
  if (this->size() != size) fail(fmt::format("has {} numbers, must have {}", this->size(), size));
  std::vector<double> result(size);
  for (std::size_t i = 0; i < size; ++i) result[i] = at(i).number();
  return result;
}

}  // namespace plisse::io
