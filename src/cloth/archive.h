// Plain values to bytes and back, and into a hash: one function `members(archive, value)` per struct lists
// its members for all three. It uses structured bindings, so that a struct with a new member does not compile
// until the member is listed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/hash.h"

namespace plisse::cloth {

template <typename T>
concept Number = std::is_arithmetic_v<T> || std::is_enum_v<T>;

// What `members` of a struct takes, constant or not.
template <typename T, typename Of>
concept Is = std::is_same_v<std::remove_const_t<T>, Of>;

template <typename T>
concept DenseMatrix = std::is_base_of_v<Eigen::PlainObjectBase<T>, T>;

// Appends.
class Writer {
 public:
  template <typename... Values>
  void operator()(const Values&... values) {
    (add(values), ...);
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  void add_raw(const void* data, std::size_t size) {
    const auto* const first = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  void add_count(std::size_t count) {
    const std::uint64_t wide = count;
    add_raw(&wide, sizeof wide);
  }
  template <typename T>
  void add(const T& value) {
    if constexpr (Number<T>) {
      add_raw(&value, sizeof value);
    } else if constexpr (DenseMatrix<T>) {
      add_count(static_cast<std::size_t>(value.rows()));
      add_count(static_cast<std::size_t>(value.cols()));
      add_raw(value.data(), sizeof(typename T::Scalar) * static_cast<std::size_t>(value.size()));
    } else {
      members(*this, value);
    }
  }
  void add(const std::string& text) {
    add_count(text.size());
    add_raw(text.data(), text.size());
  }
  void add(const std::vector<bool>& flags) {
    add_count(flags.size());
    for (const bool flag : flags) add(flag);
  }
  template <typename T>
  void add(const std::vector<T>& items) {
    add_count(items.size());
    for (const T& item : items) add(item);
  }
  template <typename T, std::size_t N>
  void add(const std::array<T, N>& items) {
    for (const T& item : items) add(item);
  }
  std::vector<std::uint8_t> bytes_;
};

// Reads what a Writer appended, in the same order. ok() is false once data was missing.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : left_(bytes) {}
  template <typename... Values>
  void operator()(Values&... values) {
    (take(values), ...);
  }
  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && left_.empty(); }

 private:
  void take_raw(void* data, std::size_t size) {
    if (size > left_.size()) {
      ok_ = false;
      left_ = {};
      return;
    }
    if (size > 0) std::memcpy(data, left_.data(), size);
    left_ = left_.subspan(size);
  }
  // The number of items of this size in bytes; 0 where there are not enough bytes for them.
  std::size_t take_count(std::size_t bytes_each) {
    std::uint64_t count = 0;
    take_raw(&count, sizeof count);
    if (count > left_.size() / std::max<std::size_t>(bytes_each, 1)) {
      ok_ = false;
      return 0;
    }
    return static_cast<std::size_t>(count);
  }
  template <typename T>
  void take(T& value) {
    if constexpr (Number<T>) {
      take_raw(&value, sizeof value);
    } else if constexpr (DenseMatrix<T>) {
      std::uint64_t rows = 0, columns = 0;
      take_raw(&rows, sizeof rows);
      take_raw(&columns, sizeof columns);
      const std::size_t room = left_.size() / sizeof(typename T::Scalar);
      const bool fits =
          (T::RowsAtCompileTime == Eigen::Dynamic || rows == std::uint64_t(T::RowsAtCompileTime)) &&
          (T::ColsAtCompileTime == Eigen::Dynamic || columns == std::uint64_t(T::ColsAtCompileTime)) &&
          (rows == 0 || columns <= room / rows);
      if (!fits) {
        ok_ = false;
        return;
      }
      value.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
      take_raw(value.data(), sizeof(typename T::Scalar) * static_cast<std::size_t>(value.size()));
    } else {
      members(*this, value);
    }
  }
  void take(std::string& text) {
    text.resize(take_count(1));
    take_raw(text.data(), text.size());
  }
  void take(std::vector<bool>& flags) {
    flags.assign(take_count(1), false);
    for (std::size_t i = 0; i < flags.size(); ++i) {
      bool flag = false;
      take(flag);
      flags[i] = flag;
    }
  }
  template <typename T>
  void take(std::vector<T>& items) {
    items.assign(take_count(1), T{});
    for (T& item : items) take(item);
  }
  template <typename T, std::size_t N>
  void take(std::array<T, N>& items) {
    for (T& item : items) take(item);
  }
  std::span<const std::uint8_t> left_;
  bool ok_ = true;
};

// Adds the bytes that a Writer would append to a hash.
class Hasher {
 public:
  explicit Hasher(Hash& hash) : hash_(hash) {}
  template <typename... Values>
  void operator()(const Values&... values) {
    Writer writer;
    writer(values...);
    hash_.add_bytes(writer.bytes());
  }

 private:
  Hash& hash_;
};

}  // namespace plisse::cloth
