// Parses FBX files into elements (see fbx_tree.h). Every count is compared with the bytes that are left
// before anything is allocated for it.
#include "io/fbx/fbx_tree.h"

#include <fmt/format.h>
#include <libdeflate.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

namespace plisse::io {
namespace {

constexpr int max_depth = 64;                       // files of programs have ten
constexpr std::size_t max_elements = 20'000'000;    // of one file
constexpr std::uint64_t max_array = 1ULL << 31;     // bytes, unpacked
constexpr std::uint64_t most_deflate_packs = 1040;  // deflate makes no more than 1032 bytes of one

[[noreturn]] void damaged(const std::string& what) {
  throw std::runtime_error(what);
}

template <typename Number>
Number read_number(const char* from) {  // little-endian, as every machine that this runs on
  Number number;
  std::memcpy(&number, from, sizeof number);
  return number;
}

std::size_t size_of(char type) {
  switch (type) {
    case 'd':
    case 'l':
      return 8;
    case 'f':
    case 'i':
      return 4;
    case 'Y':
      return 2;
    default:
      return 1;  // b, c
  }
}

class BinaryParser {
 public:
  BinaryParser(std::string_view bytes, int version) : bytes_(bytes), wide_(version >= 7500) {}

  std::vector<FbxElement> parse() {
    at_ = 27;  // magic and version
    std::vector<FbxElement> elements;
    // A null record ends the list; what follows it is a footer. Files that end without one are cut off.
    while (read(elements, bytes_.size(), 0)) {
    }
    return elements;
  }

 private:
  std::string_view take(std::uint64_t size) {
    if (size > bytes_.size() - at_) damaged(fmt::format("it ends within an element at byte {}", at_));
    const std::string_view taken = bytes_.substr(at_, static_cast<std::size_t>(size));
    at_ += static_cast<std::size_t>(size);
    return taken;
  }
  template <typename Number>
  Number number() {
    return read_number<Number>(take(sizeof(Number)).data());
  }
  std::uint64_t word() { return wide_ ? number<std::uint64_t>() : number<std::uint32_t>(); }

  // One element into the list; false at a null record.
  bool read(std::vector<FbxElement>& into, std::size_t limit, int depth) {
    if (depth > max_depth) damaged("its elements are nested too deeply");
    const std::uint64_t end = word(), count = word(), size = word();
    const auto name_size = number<std::uint8_t>();
    if (end == 0 && count == 0 && size == 0 && name_size == 0) return false;
    if (++elements_ > max_elements) damaged("it has too many elements");
    FbxElement& element = into.emplace_back();
    element.name = take(name_size);
    if (end < at_ || end > limit || size > end - at_)
      damaged(fmt::format("the element '{}' has a length that cannot be", element.name));
    const std::size_t values_end = at_ + static_cast<std::size_t>(size);
    if (count > size) damaged(fmt::format("the element '{}' has more values than bytes", element.name));
    element.values.reserve(static_cast<std::size_t>(count));
    for (std::uint64_t v = 0; v < count; ++v) element.values.push_back(value());
    if (at_ > values_end) damaged(fmt::format("the values of '{}' are longer than it says", element.name));
    at_ = values_end;
    while (at_ < end && read(element.children, static_cast<std::size_t>(end), depth + 1)) {
    }
    at_ = static_cast<std::size_t>(end);
    return true;
  }

  FbxValue value() {
    const char type = number<char>();
    switch (type) {
      case 'B':
      case 'C':
        return std::int64_t{number<std::uint8_t>()};
      case 'Y':
        return std::int64_t{number<std::int16_t>()};
      case 'I':
        return std::int64_t{number<std::int32_t>()};
      case 'L':
        return number<std::int64_t>();
      case 'F':
        return double{number<float>()};
      case 'D':
        return number<double>();
      case 'S':
      case 'R':
        return take(number<std::uint32_t>());
      case 'f':
      case 'd':
      case 'i':
      case 'l':
      case 'b':
      case 'c': {
        FbxArray array;
        array.type = type;
        array.count = number<std::uint32_t>();
        array.deflated = number<std::uint32_t>() != 0;
        array.bytes = take(number<std::uint32_t>());
        return array;
      }
      default:
        damaged(fmt::format("a value of unknown type {} at byte {}", static_cast<int>(type), at_ - 1));
    }
  }

  std::string_view bytes_;
  std::size_t at_ = 0;
  std::size_t elements_ = 0;
  bool wide_;
};

// `Name: value, value { children }`, comments from ';' to the end of a line; lists as `*count { a: 1,2 }`.
class TextParser {
 public:
  explicit TextParser(std::string_view text) : text_(text) {}

  std::vector<FbxElement> parse() {
    std::vector<FbxElement> elements;
    while (next(), at_ < text_.size()) read(elements, 0);
    return elements;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

  // Moves to the next character that says something, which it returns; 0 at the end.
  char next() {
    while (at_ < text_.size()) {
      if (is_blank(text_[at_]))
        ++at_;
      else if (text_[at_] == ';')
        at_ = std::min(text_.find('\n', at_), text_.size());
      else
        return text_[at_];
    }
    return '\0';
  }

  std::string_view until(std::string_view stops) {
    const std::size_t begin = at_;
    at_ = std::min(text_.find_first_of(stops, at_), text_.size());
    return text_.substr(begin, at_ - begin);
  }

  void read(std::vector<FbxElement>& into, int depth) {
    if (depth > max_depth) damaged("its elements are nested too deeply");
    if (++elements_ > max_elements) damaged("it has too many elements");
    FbxElement& element = into.emplace_back();
    element.name = until(": \t\r\n{};,\"");
    if (element.name.empty() || next() != ':')
      damaged(fmt::format("no element where one must begin, at byte {}", at_));
    ++at_;
    bool array = false;
    for (bool first = true;; first = false) {
      // Values stand on the element's line; those after a comma may begin on the next.
      while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\r')) ++at_;
      if (at_ >= text_.size()) return;
      if (first && (text_[at_] == '\n' || text_[at_] == ';')) {
        // `Content: ,` and elements whose brace is on the next line are of old files; values are not there.
        if (next() != '{') return;
      }
      if (text_[at_] == '{' || text_[at_] == '}') break;
      if (text_[at_] == ',') {  // an empty value
        ++at_;
        next();
        continue;
      }
      array |= value(element);
      while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\r')) ++at_;
      if (at_ < text_.size() && text_[at_] == ',') {
        ++at_;
        next();
        continue;
      }
      break;
    }
    // The brace of `*24 {` or of children.
    std::size_t after = at_;
    if (next() != '{') {
      at_ = after;
      return;
    }
    ++at_;
    if (array) {
      list(element);
      return;
    }
    while (next() != '}') {
      if (at_ >= text_.size()) damaged(fmt::format("it ends within '{}'", element.name));
      read(element.children, depth + 1);
    }
    ++at_;
  }

  // True where it was the count of a list.
  bool value(FbxElement& element) {
    const char c = text_[at_];
    if (c == '"') {
      ++at_;
      element.values.emplace_back(until("\""));
      if (at_ >= text_.size()) damaged(fmt::format("a text of '{}' has no end", element.name));
      ++at_;
      return false;
    }
    if (c == '*') ++at_;
    const std::string_view word = until(" \t\r\n,{};");
    if (c == '*') {
      FbxArray array;
      array.type = 't';
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), array.count);
      if (error != std::errc{}) damaged(fmt::format("the list '{}' has no count", element.name));
      element.values.emplace_back(array);
      return true;
    }
    if (word.empty()) damaged(fmt::format("a value of '{}' cannot be read", element.name));
    std::int64_t integer = 0;
    const char* const last = word.data() + word.size();
    if (const auto [end, error] = std::from_chars(word.data(), last, integer);
        error == std::errc{} && end == last) {
      element.values.emplace_back(integer);
      return false;
    }
    double number = 0;
    if (const auto [end, error] = std::from_chars(word.data(), last, number); end == last) {
      element.values.emplace_back(number);
      return false;
    }
    element.values.emplace_back(word);  // T, Y, W: flags of old files
    return false;
  }

  // `a: 1,2,3 }`
  void list(FbxElement& element) {
    if (next() != 'a' && text_[at_] != '}')
      damaged(fmt::format("the list '{}' has no numbers", element.name));
    const std::size_t end = text_.find('}', at_);
    if (end == std::string_view::npos) damaged(fmt::format("the list '{}' has no end", element.name));
    const std::size_t colon = text_.find(':', at_);
    auto& array = std::get<FbxArray>(element.values.back());
    if (colon < end) array.bytes = text_.substr(colon + 1, end - colon - 1);
    at_ = end + 1;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::size_t elements_ = 0;
};

int version_of_text(const std::vector<FbxElement>& elements) {
  for (const FbxElement& element : elements)
    if (element.name == "FBXHeaderExtension")
      if (const FbxElement* version = element.child("FBXVersion"))
        return static_cast<int>(std::clamp<std::int64_t>(version->integer(0), 0, 99999));
  return 0;
}

std::string inflated(const FbxArray& array, std::uint64_t size) {
  struct Free {
    void operator()(libdeflate_decompressor* one) const { libdeflate_free_decompressor(one); }
  };
  if (size / most_deflate_packs > array.bytes.size()) damaged("a list is longer than its bytes can hold");
  const std::unique_ptr<libdeflate_decompressor, Free> decompressor(libdeflate_alloc_decompressor());
  if (!decompressor) throw std::bad_alloc();
  std::string out(static_cast<std::size_t>(size), '\0');
  if (libdeflate_zlib_decompress(decompressor.get(), array.bytes.data(), array.bytes.size(), out.data(),
                                 out.size(), nullptr) != LIBDEFLATE_SUCCESS)
    damaged("a compressed list is damaged");
  return out;
}

template <typename Number>
Number converted(double value) {
  if constexpr (std::is_integral_v<Number>)
    return std::abs(value) < 9e18 ? static_cast<Number>(value) : 0;
  else
    return value;
}

template <typename Number>
std::vector<Number> numbers_of_text(const FbxArray& array) {
  // A number and its comma take two bytes.
  if (array.count > array.bytes.size() / 2 + 1) damaged("a list is shorter than it states");
  std::vector<Number> result;
  result.reserve(static_cast<std::size_t>(array.count));
  const char* at = array.bytes.data();
  const char* const end = at + array.bytes.size();
  while (true) {
    while (at < end && (*at == ' ' || *at == ',' || *at == '\n' || *at == '\r' || *at == '\t' || *at == '+'))
      ++at;
    if (at >= end) break;
    Number number{};
    auto [after, error] = std::from_chars(at, end, number);
    if constexpr (std::is_integral_v<Number>)
      if (error == std::errc{} && after < end && (*after == '.' || *after == 'e' || *after == 'E')) {
        double real = 0;
        after = std::from_chars(at, end, real).ptr;
        number = converted<Number>(real);
      }
    if (after == at) {
      // "1.#IND" and such begin with a digit; nothing else is a number.
      damaged("a list holds what is no number");
    }
    while (after < end && *after != ',' && *after != ' ' && *after != '\n' && *after != '\r' &&
           *after != '\t')
      ++after;
    result.push_back(number);
    at = after;
  }
  if (result.size() != array.count) damaged("a list holds another number of values than it states");
  return result;
}

template <typename Number>
std::vector<Number> numbers_of(const FbxArray& array) {
  if (array.type == 't') return numbers_of_text<Number>(array);
  const std::size_t width = size_of(array.type);
  const std::uint64_t size = array.count * width;
  if (size > max_array) damaged("a list is too long");
  if (!array.deflated && size > array.bytes.size()) damaged("a list is shorter than it states");
  const std::string unpacked = array.deflated ? inflated(array, size) : std::string();
  const char* const from = array.deflated ? unpacked.data() : array.bytes.data();
  std::vector<Number> result(static_cast<std::size_t>(array.count));
  for (std::size_t i = 0; i < result.size(); ++i) {
    const char* const at = from + i * width;
    switch (array.type) {
      case 'd':
        result[i] = converted<Number>(read_number<double>(at));
        break;
      case 'f':
        result[i] = converted<Number>(static_cast<double>(read_number<float>(at)));
        break;
      case 'l':
        result[i] = static_cast<Number>(read_number<std::int64_t>(at));
        break;
      case 'i':
        result[i] = static_cast<Number>(read_number<std::int32_t>(at));
        break;
      default:
        result[i] = static_cast<Number>(read_number<std::uint8_t>(at));
    }
  }
  return result;
}

template <typename Number>
std::vector<Number> list_of(const FbxElement& element) {
  if (!element.values.empty())
    if (const auto* array = std::get_if<FbxArray>(&element.values[0])) return numbers_of<Number>(*array);
  std::vector<Number> result;
  for (std::size_t v = 0; v < element.values.size(); ++v) {
    if constexpr (std::is_integral_v<Number>)
      result.push_back(element.integer(v));
    else
      result.push_back(element.number(v));
  }
  return result;
}

}  // namespace

const FbxElement* FbxElement::child(std::string_view wanted) const {
  for (const FbxElement& one : children)
    if (one.name == wanted) return &one;
  return nullptr;
}

double FbxElement::number(std::size_t value) const {
  if (value >= values.size()) return 0;
  if (const auto* real = std::get_if<double>(&values[value])) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(&values[value])) return static_cast<double>(*integer);
  return 0;
}

std::int64_t FbxElement::integer(std::size_t value) const {
  if (value >= values.size()) return 0;
  if (const auto* integer = std::get_if<std::int64_t>(&values[value])) return *integer;
  if (const auto* real = std::get_if<double>(&values[value])) return converted<std::int64_t>(*real);
  return 0;
}

std::string_view FbxElement::text(std::size_t value) const {
  if (value < values.size())
    if (const auto* text = std::get_if<std::string_view>(&values[value])) return *text;
  return {};
}

std::vector<double> FbxElement::numbers() const {
  return list_of<double>(*this);
}
std::vector<std::int64_t> FbxElement::integers() const {
  return list_of<std::int64_t>(*this);
}

FbxTree::FbxTree(std::string bytes) : bytes_(std::move(bytes)) {
  constexpr std::string_view magic("Kaydara FBX Binary  \0\x1a\0", 23);
  if (std::string_view(bytes_).starts_with(magic)) {
    if (bytes_.size() < 27) damaged("it ends within its head");
    version_ = static_cast<int>(
        std::min<std::uint32_t>(read_number<std::uint32_t>(bytes_.data() + magic.size()), 99999));
    if (version_ >= 7000) root_.children = BinaryParser(bytes_, version_).parse();
  } else {
    root_.children = TextParser(bytes_).parse();
    version_ = version_of_text(root_.children);
  }
  if (version_ < 7000) damaged(fmt::format("its version is {}", version_));
}

}  // namespace plisse::io
