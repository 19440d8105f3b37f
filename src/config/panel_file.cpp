#include "config/panel_file.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/units.h"
#include "config/complaints.h"
#include "config/fabric_key.h"
#include "config/garment_code.h"
#include "config/kinds.h"
#include "config/suggest.h"
#include "config/table_reader.h"
#include "sizing/obj_lines.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;
using config::Complaints;
using config::TableReader;
using glm::dvec2;
using sizing::Feature;

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr const char* curve_allowed =
    "SVG path data, an array of points [[x, y], …], { spline = [[x, y], …], closed = true } or { svg = FILE, "
    "id = NAME } or { obj = FILE, id = NAME }";

class PanelReader {
 public:
  // `in_place`: of all panels, whatever the file has; none: nullptr.
  PanelReader(PanelFile& file, const fs::path& folder, const sizing::Fabric* in_place, Complaints& complaints)
      : file_(file), folder_(folder), in_place_(in_place), complaints_(complaints) {}

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
    std::optional<sizing::Fabric> common;
    if (const toml::node* node = reader.node("fabric")) {
      // A wrong one is complained of once, not by every panel that misses it.
      common = config::read_fabric(*node, metres, complaints_).value_or(sizing::Fabric{});
    }
    if (in_place_) common = *in_place_;
    if (const toml::node* sizing = reader.node("sizing")) options(*sizing, metres);
    const toml::node* panels = reader.needed("panel", "tables [[panel]]");
    if (panels && panels->is_array_of_tables()) {
      for (const toml::node& panel : *panels->as_array()) read_panel(*panel.as_table(), metres, common);
    } else if (panels && panels->is_table()) {
      read_panel(*panels->as_table(), metres, common);
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

  // One curve, wherever it is from; of an outline's several, those that lie in it are its holes.
  template <typename Parse>
  std::optional<sizing::Polyline> path(TableReader& reader, const std::string& key, const toml::node& node,
                                       bool closed, const Parse& parse,
                                       std::vector<sizing::Polyline>* holes = nullptr) {
    try {
      auto lines = parse();
      if (lines.empty() || (lines.size() != 1 && !holes)) {
        reader.complain(node, key, fmt::format("has {} subpaths; one is wanted", lines.size()));
        return std::nullopt;
      }
      for (sizing::Polyline& line : lines) {
        for (dvec2& point : line.points) point *= reader.metres();
        line.closed |= closed;
        line = without_repeats(std::move(line));
      }
      if (holes) holes->insert(holes->end(), lines.begin() + 1, lines.end());
      return std::move(lines[0]);
    } catch (const Error& error) {
      reader.complain(node, key, error.what());
      return std::nullopt;
    }
  }

  // The file's name stands before what is wrong with it.
  static std::vector<sizing::Polyline> svg_curves(const fs::path& file, const std::string& id) {
    const std::string document = read_whole_text(file);
    try {
      return sizing::parse_svg(document, id);
    } catch (const Error& error) {
      throw Error(error.code, fmt::format("{}: {}", file.string(), error.what()));
    }
  }

  std::optional<sizing::Polyline> curve(TableReader& reader, const std::string& key, const toml::node& node,
                                        bool closed, std::vector<sizing::Polyline>* holes = nullptr) {
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
      std::string svg, obj, id;
      table.text("svg", svg);
      table.text("obj", obj);
      table.text("id", id);
      if (!svg.empty() || !obj.empty()) {
        table.finish();
        if (!svg.empty() && !obj.empty()) {
          reader.complain(node, key, "has 'svg' and 'obj'; take one of them out");
          return std::nullopt;
        }
        const auto parse = [&] {
          return !svg.empty() ? svg_curves(folder_ / svg, id)
                 : holes      ? sizing::read_obj_outline(folder_ / obj, id)
                              : sizing::read_obj_lines(folder_ / obj, id);
        };
        return path(reader, key, node, closed, parse, svg.empty() ? holes : nullptr);
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

  void read_panel(const toml::table& table, double metres, const std::optional<sizing::Fabric>& common) {
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
    if (const toml::node* node = reader.node("fabric")) {
      const auto fabric = config::read_fabric(*node, metres, complaints_);
      if (fabric && !in_place_) panel.fabric = *fabric;
    } else if (!common) {
      complaints_.add(table.source().begin,
                      "key 'fabric': missing; give it to the panel or above all panels");
    }
    if (const toml::node* node = reader.needed("outline", curve_allowed)) {
      if (auto outline = curve(reader, "outline", *node, true, &panel.holes))
        panel.outline = std::move(*outline);
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
  const sizing::Fabric* in_place_;
  Complaints& complaints_;
  std::set<std::string> names_;
  bool any_placed_ = false;
};

}  // namespace

PanelFile load_panels(const fs::path& file, const sizing::Fabric* fabric) {
  const std::string text = read_whole_text(file);
  if (file.extension() != ".json") return parse_panels(text, file, fabric);
  if (!fabric)
    throw Error(
        ExitCode::bad_input,
        fmt::format("{}: a GarmentCode pattern tells no fabric; give one beside it, a name or B,E: --fabric, "
                    "or 'fabric' in the scene",
                    file.string()));
  PanelFile result;
  result.garment = parse_garment_code(text, file, *fabric);
  return result;
}

PanelFile parse_panels(std::string_view text, const fs::path& file, const sizing::Fabric* fabric) {
  Complaints complaints(file);
  const toml::table root = config::parse_toml(text, file);
  PanelFile result;
  PanelReader(result, file.parent_path(), fabric, complaints).read(root);
  complaints.throw_if_any();
  return result;
}

void keep_pieces(PanelFile& file, const std::vector<std::string>& names) {
  if (names.empty()) return;
  sizing::Garment& garment = file.garment;
  std::vector<std::string> known;
  for (const sizing::Panel& panel : garment.panels) known.push_back(panel.name);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ExitCode::bad_input, fmt::format("there is no panel '{}'; allowed: {}{}", name,
                                                   config::either(known), did_you_mean(name, known)));
  sizing::Garment kept;
  std::vector<std::size_t> place(known.size(), known.size());
  for (std::size_t p = 0; p < known.size(); ++p) {
    if (std::find(names.begin(), names.end(), known[p]) == names.end()) continue;
    place[p] = kept.panels.size();
    kept.panels.push_back(garment.panels[p]);
    if (!garment.placements.empty()) kept.placements.push_back(garment.placements[p]);
  }
  for (sizing::Seam seam : garment.seams) {
    if (place[seam.a.panel] == known.size() || place[seam.b.panel] == known.size()) continue;
    seam.a.panel = place[seam.a.panel];
    seam.b.panel = place[seam.b.panel];
    kept.seams.push_back(std::move(seam));
  }
  garment = std::move(kept);
}

bool is_panel_file(const fs::path& file) {
  const toml::table root = config::parse_toml(read_whole_text(file), file);
  return root.contains("panel") && !root.contains("model") && !root.contains("drape");
}

}  // namespace plisse::config
