#include "config/panel_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/units.h"
#include "config/complaints.h"
#include "config/garment_code.h"
#include "config/kinds.h"
#include "config/suggest.h"

namespace plisse {
namespace {

namespace fs = std::filesystem;
using config::Complaints;
using glm::dvec2;
using sizing::Feature;

constexpr double infinity = std::numeric_limits<double>::infinity();

// One table of the file: reads its keys with their ranges, and at the end complains about those nobody asked
// for.
class TableReader {
 public:
  TableReader(const toml::table& table, std::string name, double metres, Complaints& complaints)
      : table_(table), name_(std::move(name)), metres_(metres), complaints_(complaints) {}
  TableReader(const TableReader&) = delete;
  TableReader& operator=(const TableReader&) = delete;

  // Call last: what has not been asked for by then is unknown.
  void finish() {
    const std::vector<std::string> names(asked_.begin(), asked_.end());
    for (const auto& [key, node] : table_) {
      const std::string given(key.str());
      if (asked_.contains(given)) continue;
      complaints_.add(key.source().begin, fmt::format("key '{}': unknown in {}; allowed: {}{}", given, name_,
                                                      config::either(names), did_you_mean(given, names)));
    }
  }

  const toml::node* node(const std::string& key) {
    asked_.insert(key);
    return table_.get(key);
  }
  const toml::node* needed(const std::string& key, const char* allowed) {
    const toml::node* found = node(key);
    if (!found)
      complaints_.add(table_.source().begin,
                      fmt::format("key '{}': missing in {}; allowed: {}", key, name_, allowed));
    return found;
  }
  void complain(const toml::node& at, const std::string& key, const std::string& text) {
    complaints_.add(at.source().begin, fmt::format("key '{}': {}", key, text));
  }

  void text(const std::string& key, std::string& value) {
    const toml::node* found = node(key);
    if (!found) return;
    if (const auto given = found->value<std::string>(); found->is_string()) {
      value = *given;
    } else {
      complain(*found, key, "is no text; allowed: a text in quotes");
    }
  }

  // A number, or a text that `parse` understands.
  using Parse = std::function<std::optional<double>(std::string_view)>;
  std::optional<double> number_of(const toml::node& at, const Parse& parse, double factor) const {
    if (at.is_number()) return *at.value<double>() * factor;
    if (at.is_string() && parse) return parse(*at.value<std::string>());
    return std::nullopt;
  }
  bool number(const std::string& key, double& value, double low, double high, const char* allowed,
              const Parse& parse = {}, double factor = 1) {
    const toml::node* found = node(key);
    if (!found) return false;
    const auto given = number_of(*found, parse, factor);
    if (!given || !(*given >= low) || !(*given <= high) || !std::isfinite(*given)) {
      complain(
          *found, key,
          fmt::format("{}; allowed: {}",
                      given ? fmt::format("{:g} is out of range", *given) : "is no such value", allowed));
      return false;
    }
    value = *given;
    return true;
  }
  // In the file's unit, or a text with one.
  bool length(const std::string& key, double& value, double low, const char* allowed) {
    return number(key, value, low, 1e9, allowed, parse_length, metres_);
  }
  std::optional<double> length_of(const toml::node& at) const { return number_of(at, parse_length, metres_); }

  template <typename Value>
  void word(const std::string& key, Value& value, const std::vector<std::pair<std::string, Value>>& words) {
    std::string given;
    text(key, given);
    if (given.empty()) return;
    std::vector<std::string> names;
    for (const auto& [name, meaning] : words) {
      if (name == given) {
        value = meaning;
        return;
      }
      names.push_back(name);
    }
    complain(*table_.get(key), key,
             fmt::format("'{}' is unknown; allowed: {}{}", given, config::either(names),
                         did_you_mean(given, names)));
  }

  const toml::table& table() const { return table_; }
  const std::string& name() const { return name_; }
  double metres() const { return metres_; }

 private:
  const toml::table& table_;
  std::string name_;
  double metres_;
  Complaints& complaints_;
  std::set<std::string> asked_;
};

constexpr const char* curve_allowed =
    "SVG path data, an array of points [[x, y], …], { spline = [[x, y], …], closed = true } or { svg = FILE, "
    "id = NAME }";

class PanelReader {
 public:
  PanelReader(PanelFile& file, const fs::path& folder, Complaints& complaints)
      : file_(file), folder_(folder), complaints_(complaints) {}

  void read(const toml::table& root) {
    double metres = 1;
    if (const toml::node* units = root.get("units")) {
      const auto length =
          units->is_string() ? parse_length("1 " + *units->value<std::string>()) : std::nullopt;
      if (length) {
        metres = *length;
      } else {
        complaints_.add(units->source().begin,
                        fmt::format("key 'units': is no unit; allowed: {}", length_units));
      }
    }
    TableReader reader(root, "the file", metres, complaints_);
    reader.node("units");
    sizing::Fabric fabric;
    read_fabric(reader, fabric);
    const bool common = root.contains("fabric");  // a wrong one is complained of once
    if (const toml::node* sizing = reader.node("sizing")) options(*sizing, metres);
    const toml::node* panels = reader.needed("panel", "tables [[panel]]");
    if (panels && panels->is_array_of_tables()) {
      for (const toml::node& panel : *panels->as_array())
        read_panel(*panel.as_table(), metres, common ? &fabric : nullptr);
    } else if (panels && panels->is_table()) {
      read_panel(*panels->as_table(), metres, common ? &fabric : nullptr);
    } else if (panels) {
      reader.complain(*panels, "panel", "is no table; write [[panel]] and its keys below");
    }
    if (const toml::node* seams = reader.node("seam")) {
      if (!seams->is_array_of_tables()) {
        reader.complain(*seams, "seam", "is no list of tables; write [[seam]] and its keys below");
      } else {
        for (const toml::node& seam : *seams->as_array()) read_seam(*seam.as_table(), metres);
      }
    }
    if (!any_placed_) file_.garment.placements.clear();
    reader.finish();
  }

 private:
  // Of the key 'fabric': a known name, or a table of numbers. False: none given, or a wrong one.
  bool read_fabric(TableReader& reader, sizing::Fabric& fabric) {
    const toml::node* node = reader.node("fabric");
    if (!node) return false;
    if (node->is_string()) {
      const std::string name = *node->value<std::string>();
      if (const sizing::Fabric* known = sizing::find_fabric(name)) {
        fabric = *known;
        return true;
      }
      std::vector<std::string> names;
      for (const sizing::Fabric& known : sizing::fabrics()) names.push_back(known.name);
      reader.complain(*node, "fabric",
                      fmt::format("'{}' is unknown; allowed: {}, or a table with B and E{}", name,
                                  config::either(names), did_you_mean(name, names)));
      return false;
    }
    if (!node->is_table()) {
      reader.complain(*node, "fabric", "is neither a name nor a table with B and E");
      return false;
    }
    TableReader table(*node->as_table(), "fabric", reader.metres(), complaints_);
    fabric.source = "panel file";
    table.text("name", fabric.name);
    table.number("poisson", fabric.poisson_ratio, 0, 0.5, "0 to 0.5");
    double value = 0;
    if (table.length("thickness", value, 1e-7, "above 0")) fabric.thickness = value;
    if (table.number("density", value, 1e-9, 1e3, "above 0, in kg/m² or with a unit such as g/m²",
                     sizing::parse_density))
      fabric.density = value;
    bool good = false;
    if (table.table().contains("weft") || table.table().contains("warp")) {
      good = direction(table, "weft", fabric, fabric.weft);
      good &= direction(table, "warp", fabric, fabric.warp);
    } else {
      good = stiffness(table, fabric, fabric.weft);
      fabric.warp = fabric.weft;
    }
    table.finish();
    return good;
  }

  bool direction(TableReader& table, const std::string& key, const sizing::Fabric& fabric,
                 sizing::Stiffness& result) {
    const toml::node* node = table.needed(key, "a table with B and E");
    if (!node) return false;
    if (!node->is_table()) {
      table.complain(*node, key, "is no table; allowed: { B = …, E = … }");
      return false;
    }
    TableReader inner(*node->as_table(), key, table.metres(), complaints_);
    const bool good = stiffness(inner, fabric, result);
    inner.finish();
    return good;
  }

  // B and E; or E and the fabric's thickness.
  bool stiffness(TableReader& table, const sizing::Fabric& fabric, sizing::Stiffness& result) {
    constexpr double least = std::numeric_limits<double>::min();
    const bool has_modulus =
        table.number("E", result.modulus, least, 1e15, "above 0, in N/m² or with a unit such as MPa",
                     sizing::parse_modulus);
    const bool has_bending =
        table.number("B", result.bending, least, 1e9, "above 0, in N·m or with a unit such as gf·cm²/cm",
                     sizing::parse_bending);
    if (has_modulus && has_bending) return true;
    if (has_modulus && !table.table().contains("B") && fabric.thickness) {
      result.bending = sizing::bending_stiffness(result.modulus, *fabric.thickness, fabric.poisson_ratio);
      return true;
    }
    if (!table.table().contains("E")) table.needed("E", "Young's modulus in N/m², or with a unit");
    if (!table.table().contains("B") && !fabric.thickness)
      table.needed("B", "bending stiffness in N·m, or with a unit; or give the fabric's 'thickness'");
    return false;
  }

  void options(const toml::node& node, double metres) {
    if (!node.is_table()) {
      complaints_.add(node.source().begin, "key 'sizing': is a table; write [sizing] and its keys below");
      return;
    }
    TableReader reader(*node.as_table(), "[sizing]", metres, complaints_);
    sizing::SizingOptions& options = file_.options;
    reader.word<sizing::Transition::Form>(
        "transition", options.form,
        {{"unit-free", sizing::Transition::Form::unit_free}, {"literal", sizing::Transition::Form::literal}});
    reader.word<sizing::FoldRule>(
        "fold", options.fold_rule,
        {{"complement", sizing::FoldRule::complement}, {"literal", sizing::FoldRule::literal}});
    reader.length("floor", options.floor, 1e-6, "0.001 mm or more");
    reader.length("fold_offset", options.fold_offset, 0, "0 (no lines beside folds) or more");
    reader.number("gradation", options.gradation, 0.01, 0.5, "0.01 to 0.5");
    double seed = options.seed;
    if (reader.number("seed", seed, 0, 4294967295.0, "a whole number from 0"))
      options.seed = static_cast<std::uint32_t>(seed);
    reader.number("B_min", file_.range.bending_min, 0, infinity, "N·m", sizing::parse_bending);
    reader.number("B_max", file_.range.bending_max, 0, infinity, "N·m", sizing::parse_bending);
    reader.number("E_min", file_.range.modulus_min, 0, infinity, "N/m²", sizing::parse_modulus);
    reader.number("E_max", file_.range.modulus_max, 0, infinity, "N/m²", sizing::parse_modulus);
    reader.length("r_min", file_.range.resolution_min, 0, "a length");
    reader.length("r_max", file_.range.resolution_max, 0, "a length");
    try {
      options.law = sizing::resolution_law(file_.range);
    } catch (const Error& error) {
      complaints_.add(node.source().begin, error.what());
    }
    reader.finish();
  }

  static bool point_of(const TableReader& reader, const toml::node& node, dvec2& point) {
    const toml::array* pair = node.as_array();
    if (!pair || pair->size() != 2) return false;
    for (int i = 0; i < 2; ++i) {
      const auto length = reader.length_of(*pair->get(static_cast<std::size_t>(i)));
      if (!length || !std::isfinite(*length)) return false;
      point[i] = *length;
    }
    return true;
  }

  std::optional<std::vector<dvec2>> points(TableReader& reader, const std::string& key,
                                           const toml::node& node) {
    std::vector<dvec2> result;
    const auto wrong = [&](const toml::node& at) {
      reader.complain(at, key, "holds something that is no point; allowed: [x, y], two lengths");
      return std::nullopt;
    };
    if (!node.is_array()) return wrong(node);
    for (const toml::node& item : *node.as_array()) {
      dvec2 point(0);
      if (!point_of(reader, item, point)) return wrong(item);
      result.push_back(point);
    }
    return result;
  }

  // One subpath of path data, wherever it is from.
  template <typename Parse>
  std::optional<sizing::Polyline> path(TableReader& reader, const std::string& key, const toml::node& node,
                                       bool closed, const Parse& parse) {
    try {
      auto lines = parse();
      if (lines.size() != 1) {
        reader.complain(node, key, fmt::format("has {} subpaths; one is wanted", lines.size()));
        return std::nullopt;
      }
      for (dvec2& point : lines[0].points) point *= reader.metres();
      lines[0].closed |= closed;
      return without_repeats(std::move(lines[0]));
    } catch (const Error& error) {
      reader.complain(node, key, error.what());
      return std::nullopt;
    }
  }

  std::optional<sizing::Polyline> curve(TableReader& reader, const std::string& key, const toml::node& node,
                                        bool closed) {
    if (node.is_string()) {
      return path(reader, key, node, closed, [&] { return sizing::parse_path(*node.value<std::string>()); });
    }
    if (node.is_array()) {
      const auto corners = points(reader, key, node);
      if (!corners) return std::nullopt;
      return sizing::without_repeats({*corners, closed});
    }
    if (node.is_table()) {
      TableReader table(*node.as_table(), key, reader.metres(), complaints_);
      std::string svg, id;
      table.text("svg", svg);
      table.text("id", id);
      if (!svg.empty()) {
        table.finish();
        return path(reader, key, node, closed, [&] {
          const fs::path name = folder_ / svg;
          const auto bytes = read_whole_file(name);
          try {
            return sizing::parse_svg({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, id);
          } catch (const Error& error) {
            throw Error(error.code, fmt::format("{}: {}", name.string(), error.what()));
          }
        });
      }
      const toml::node* through = table.needed("spline", "an array of points [[x, y], …]");
      if (const toml::node* given = table.node("closed")) closed |= given->value_or(false);
      table.finish();
      const auto corners = through ? points(table, "spline", *through) : std::nullopt;
      if (!corners) return std::nullopt;
      return sizing::spline_through(*corners, closed);
    }
    reader.complain(node, key, fmt::format("is no curve; allowed: {}", curve_allowed));
    return std::nullopt;
  }

  void read_panel(const toml::table& table, double metres, const sizing::Fabric* common) {
    sizing::Panel panel;
    panel.name = fmt::format("panel{}", file_.garment.panels.size() + 1);
    TableReader reader(table, "[[panel]]", metres, complaints_);
    reader.text("name", panel.name);
    if (panel.name.empty() || panel.name.find_first_of("/\\\n") != std::string::npos ||
        panel.name.front() == '.')
      reader.complain(*table.get("name"), "name", "names files: no empty text, no slashes, no dot in front");
    if (!names_.insert(panel.name).second)
      complaints_.add(table.source().begin, fmt::format("key 'name': there are two panels '{}'", panel.name));
    reader.number("grain", panel.grain, -360, 360, "degrees from x to the warp");
    if (common) panel.fabric = *common;
    if (!read_fabric(reader, panel.fabric) && !common && !table.contains("fabric"))
      complaints_.add(table.source().begin,
                      "key 'fabric': missing; give it to the panel or above all panels");
    if (const toml::node* node = reader.needed("outline", curve_allowed)) {
      if (auto outline = curve(reader, "outline", *node, true)) panel.outline = std::move(*outline);
    }
    if (const toml::node* holes = reader.node("holes")) {
      if (!holes->is_array()) {
        reader.complain(*holes, "holes", "is no array of curves");
      } else {
        for (const toml::node& hole : *holes->as_array()) {
          if (auto shape = curve(reader, "holes", hole, true)) panel.holes.push_back(std::move(*shape));
        }
      }
    }
    if (const toml::node* features = reader.node("feature")) {
      if (!features->is_array_of_tables()) {
        reader.complain(*features, "feature",
                        "is no list of tables; write [[panel.feature]] and its keys below");
      } else {
        for (const toml::node& feature : *features->as_array())
          read_feature(*feature.as_table(), metres, panel);
      }
    }
    read_placement(reader);
    reader.finish();
    file_.garment.panels.push_back(std::move(panel));
  }

  // 'translation' and 'rotation': degrees round x, then y, then z, axes that do not turn with the panel.
  void read_placement(TableReader& reader) {
    sizing::Placement placement;
    const auto three = [&](const char* key, const char* allowed, auto value_of) -> std::optional<glm::dvec3> {
      const toml::node* node = reader.node(key);
      if (!node) return std::nullopt;
      any_placed_ = true;
      const toml::array* numbers = node->as_array();
      glm::dvec3 result(0);
      for (int i = 0; i < 3; ++i) {
        const std::optional<double> value = numbers && numbers->size() == 3
                                                ? value_of(*numbers->get(static_cast<std::size_t>(i)))
                                                : std::nullopt;
        if (!value || !std::isfinite(*value)) {
          reader.complain(*node, key, fmt::format("is no such thing; allowed: {}", allowed));
          return std::nullopt;
        }
        result[i] = *value;
      }
      return result;
    };
    const auto length = [&](const toml::node& node) { return reader.length_of(node); };
    if (const auto at = three("translation", "[x, y, z], lengths", length)) placement.translation = *at;
    const auto degrees = [](const toml::node& node) { return node.value<double>(); };
    if (const auto turn = three("rotation", "[x, y, z], degrees", degrees))
      placement.rotation = sizing::turned_by(*turn);
    file_.garment.placements.push_back(placement);
  }

  void read_seam(const toml::table& table, double metres) {
    sizing::Seam seam;
    seam.name = fmt::format("seam{}", file_.garment.seams.size() + 1);
    TableReader reader(table, "[[seam]]", metres, complaints_);
    reader.text("name", seam.name);
    const bool good = read_side(reader, "a", metres, seam.a) & read_side(reader, "b", metres, seam.b);
    reader.finish();
    if (good) file_.garment.seams.push_back(std::move(seam));
  }

  bool read_side(TableReader& seam, const char* key, double metres, sizing::SeamSide& side) {
    constexpr const char* allowed = "{ panel = NAME, from = [x, y], to = [x, y], long_way = true or false }";
    const toml::node* node = seam.needed(key, allowed);
    if (!node) return false;
    if (!node->is_table()) {
      seam.complain(*node, key, fmt::format("is no table; allowed: {}", allowed));
      return false;
    }
    TableReader reader(*node->as_table(), fmt::format("the seam's '{}'", key), metres, complaints_);
    std::string name;
    bool good = reader.needed("panel", "the name of a panel") != nullptr;
    reader.text("panel", name);
    const auto& panels = file_.garment.panels;
    const auto found = std::find_if(panels.begin(), panels.end(),
                                    [&](const sizing::Panel& panel) { return panel.name == name; });
    if (found != panels.end()) {
      side.panel = static_cast<std::size_t>(found - panels.begin());
    } else if (good) {
      std::vector<std::string> names;
      for (const sizing::Panel& panel : panels) names.push_back(panel.name);
      reader.complain(*node->as_table()->get("panel"), "panel",
                      fmt::format("there is no panel '{}'; allowed: {}{}", name, config::either(names),
                                  did_you_mean(name, names)));
      good = false;
    }
    const auto point = [&](const char* end, dvec2& value) {
      const toml::node* given = reader.needed(end, "a point [x, y] of the panel's outline");
      if (!given) return false;
      if (!point_of(reader, *given, value)) {
        reader.complain(*given, end, "is no point; allowed: [x, y], two lengths");
        return false;
      }
      return true;
    };
    good &= point("from", side.from);
    good &= point("to", side.to);
    if (const toml::node* given = reader.node("long_way")) {
      if (given->is_boolean())
        side.long_way = *given->value<bool>();
      else
        reader.complain(*given, "long_way", "is neither true nor false");
    }
    reader.finish();
    return good;
  }

  void read_feature(const toml::table& table, double metres, sizing::Panel& panel) {
    Feature feature;
    TableReader reader(table, "[[panel.feature]]", metres, complaints_);
    std::optional<Feature::Rule> rule;
    reader.needed("rule", "shirring, fold, stitch, cell or collision");
    reader.word<std::optional<Feature::Rule>>("rule", rule,
                                              {{"shirring", Feature::Rule::shirring},
                                               {"fold", Feature::Rule::fold},
                                               {"stitch", Feature::Rule::stitch},
                                               {"cell", Feature::Rule::cell},
                                               {"collision", Feature::Rule::collision}});
    if (!rule) return;
    feature.rule = *rule;
    const bool region = *rule == Feature::Rule::cell || *rule == Feature::Rule::collision;
    feature.name = fmt::format("{}{}", name_of(*rule), panel.features.size() + 1);
    reader.text("name", feature.name);
    if (const toml::node* line = reader.needed("line", curve_allowed)) {
      if (auto shape = curve(reader, "line", *line, region)) feature.line = std::move(*shape);
    }
    constexpr double least_ratio = 1e-3;
    if (*rule == Feature::Rule::shirring || region)
      reader.number("ratio", feature.ratio, least_ratio, 1, "contracted over rest length, 0.001 to 1 (none)");
    if (*rule != Feature::Rule::fold) {
      reader.number("stiffness", feature.added_modulus, 0, 1e15, "0 or more, in N/m² or with a unit",
                    sizing::parse_modulus);
      reader.number("exponent", feature.exponent, 0, 100, "0 to 100");
    }
    if (*rule == Feature::Rule::fold) {
      reader.needed("angle", "degrees from flat, 0 to 360");
      reader.number("angle", feature.angle, 0, 360, "degrees from flat, 0 to 360");
    }
    if (*rule == Feature::Rule::stitch) {
      reader.needed("other_length", "length of the line it is sewn to");
      reader.length("other_length", feature.other_length, 1e-9, "above 0");
    }
    if (*rule == Feature::Rule::cell) reader.number("pressure", feature.cause.pressure, 0, 1e6, "0 or more");
    reader.number("tension", feature.cause.tension, 0, 1e9, "N/m, 0 or more");
    reader.number("transition", feature.cause.prefactor, 1e-6, 1e6,
                  "factor on the transition's length, above 0");
    feature.cause.poisson_ratio = panel.fabric.poisson_ratio;
    reader.finish();
    panel.features.push_back(std::move(feature));
  }

  PanelFile& file_;
  fs::path folder_;  // paths start here
  Complaints& complaints_;
  std::set<std::string> names_;
  bool any_placed_ = false;
};

}  // namespace

PanelFile load_panels(const fs::path& file, const sizing::Fabric* fabric) {
  const auto bytes = read_whole_file(file);
  const std::string_view text{reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  if (file.extension() != ".json") {
    if (fabric)
      throw Error(
          ExitCode::bad_input,
          fmt::format("{}: has its own fabrics; give --fabric to .json patterns alone", file.string()));
    return parse_panels(text, file);
  }
  if (!fabric)
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: a GarmentCode pattern tells no fabric; add --fabric NAME or B,E", file.string()));
  PanelFile result;
  result.garment = parse_garment_code(text, file, *fabric);
  return result;
}

PanelFile parse_panels(std::string_view text, const fs::path& file) {
  Complaints complaints(file);
  toml::table root;
  try {
    root = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    complaints.add(error.source().begin, fmt::format("not TOML: {}", error.description()));
    complaints.throw_if_any();
  }
  PanelFile result;
  PanelReader(result, file.parent_path(), complaints).read(root);
  complaints.throw_if_any();
  return result;
}

}  // namespace plisse
