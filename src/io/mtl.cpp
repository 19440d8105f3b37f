#include "io/mtl.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/log.h"
#include "base/text.h"
#include "base/units.h"
#include "io/obj.h"

namespace plisse::io {
namespace {

// Options of textures, the most words that follow each, and the words that say what is so without the option.
struct Option {
  std::string_view name;
  int words;
  std::string_view usual;
};
constexpr std::array<Option, 13> options{{{"-blendu", 1, "on"},
                                          {"-blendv", 1, "on"},
                                          {"-bm", 1, ""},
                                          {"-boost", 1, "0"},
                                          {"-cc", 1, "off"},
                                          {"-clamp", 1, "off"},
                                          {"-imfchan", 1, ""},
                                          {"-mm", 2, "0 1"},
                                          {"-o", 3, ""},
                                          {"-s", 3, ""},
                                          {"-t", 3, "0 0 0"},
                                          {"-texres", 1, ""},
                                          {"-type", 1, ""}}};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : path_(path) {}

  std::vector<MtlMaterial> read() {
    for_each_line(read_obj_text(path_), [&](std::string_view line, std::size_t) { read_line(line); });
    return std::move(materials_);
  }

 private:
  void warn_unread(std::string_view what) const {
    log::warn_once(fmt::format("mtl {} {}", path_.string(), what),
                   fmt::format("{}: {} is not read", path_.string(), what));
  }

  void read_line(std::string_view rest) {
    const std::string key = lower_case(std::string(next_word(rest)));
    if (key == "newmtl") {
      materials_.emplace_back().name = trimmed(rest);
      return;
    }
    if (materials_.empty()) return;
    MtlMaterial& material = materials_.back();
    if (key == "kd") {
      glm::vec3 colour{0};
      int read = 0;
      for (; read < 3; ++read) {
        const auto value = number(rest);
        if (!value) break;
        colour[read] = *value;
      }
      // One number is a grey.
      if (read == 1) colour = glm::vec3(colour.r);
      if (read == 1 || read == 3) material.colour = colour;
      if (read == 0 || read == 2)
        warn_unread(fmt::format("the 'Kd' of material '{}', which is no three numbers,", material.name));
    } else if (key == "d" || key == "tr") {
      if (const auto value = number(rest)) {
        const float opacity = key == "d" ? *value : 1 - *value;
        // Some writers use 0 for Tr and d alike; an invisible material is not what they mean.
        material.opacity = opacity > 0 && opacity <= 1 ? opacity : 1;
      } else {
        warn_unread(fmt::format("the '{}' of material '{}', which is no number,", key, material.name));
      }
    } else if (key == "map_kd") {
      material.picture = picture(rest);
    } else if (key == "map_d") {
      material.opacity_picture = picture(rest);
    } else if (key == "ke") {
      const auto value = number(rest), green = number(rest), blue = number(rest);
      if (value.value_or(0) > 0 || green.value_or(0) > 0 || blue.value_or(0) > 0)
        warn_unread("'Ke' (emission)");
    } else if (key == "bump" || key == "map_bump" || key == "norm" || key == "disp" || key == "decal" ||
               key == "map_ke" || key == "map_tr") {
      warn_unread(fmt::format("'{}'", key));
    }
  }

  static std::optional<float> number(std::string_view& rest) {
    std::string_view after = rest;
    const auto value = parse_number(next_word(after));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    rest = after;
    return static_cast<float>(*value);
  }

  // Options stand before the name, which may have blanks.
  MtlPicture picture(std::string_view rest) const {
    MtlPicture result;
    for (rest = trimmed(rest); rest.starts_with('-'); rest = trimmed(rest)) {
      std::string_view after = rest;
      const std::string name = lower_case(std::string(next_word(after)));
      const auto option =
          std::find_if(options.begin(), options.end(), [&](const Option& one) { return one.name == name; });
      if (option == options.end()) {
        if (trimmed(after).empty()) break;  // a name that begins with a dash
        warn_unread(fmt::format("the texture option '{}'", name));
        rest = after;
        continue;
      }
      rest = after;
      std::vector<float> numbers;
      std::string words;
      for (int i = 0; i < option->words; ++i) {
        const bool of_numbers = option->words > 1;
        if (of_numbers) {
          const auto value = number(rest);
          if (!value) break;
          numbers.push_back(*value);
          words += fmt::format("{}{}", words.empty() ? "" : " ", *value);
        } else {
          words = lower_case(std::string(next_word(rest)));
          if (const auto value = parse_number(words)) words = fmt::format("{}", *value);
        }
      }
      if (name == "-s" || name == "-o") {
        glm::vec2& to = name == "-s" ? result.scale : result.offset;
        for (int i = 0; i < 2 && static_cast<std::size_t>(i) < numbers.size(); ++i)
          to[i] = numbers[static_cast<std::size_t>(i)];
      } else if (name != "-bm" && name != "-texres" && name != "-type" && words != option->usual) {
        warn_unread(fmt::format("the texture option '{} {}'", name, words));
      }
    }
    if (rest.size() > 1 && rest.starts_with('"') && rest.ends_with('"'))
      rest = rest.substr(1, rest.size() - 2);
    result.name = rest;
    return result;
  }

  std::filesystem::path path_;
  std::vector<MtlMaterial> materials_;
};

}  // namespace

std::vector<MtlMaterial> read_mtl(const std::filesystem::path& path) {
  return Reader(path).read();
}

}  // namespace plisse::io
