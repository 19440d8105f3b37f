#include "config/panel_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/units.h"
#include "config/fabric_key.h"
#include "config/file_reader.h"
#include "config/garment_code.h"
#include "config/suggest.h"
#include "sizing/obj_lines.h"

namespace plisse::config {
namespace {

namespace fs = std::filesystem;
using glm::dvec2;
using sizing::Feature;
using sizing::Polyline;
using Rule = Feature::Rule;

constexpr double infinity = std::numeric_limits<double>::infinity();

// --- curves

constexpr const char* curve_allowed =
    "SVG path data, an array of points [[x, y], …], { spline = [[x, y], …], closed = true } or { svg = FILE, "
    "id = NAME } or { obj = FILE, id = NAME }";

struct CurveTable {
  std::string svg, obj, id;
  std::vector<dvec2> spline;
  bool closed = false;
};

std::vector<dvec2> points_of(const Given& given) {
  const auto wrong = [](const toml::node& at, const std::string& what) {
    return Problem{fmt::format("holds something that is no point [x, y] of two lengths: {}", what), "",
                   at.source().begin.line, at.source().begin.column};
  };
  std::vector<dvec2> points;
  if (!given.node.is_array()) throw wrong(given.node, "this is no array");
  for (const toml::node& item : *given.node.as_array()) {
    try {
      points.push_back(flat_point().read(given.part(item)));
    } catch (const Problem& problem) {
      throw wrong(item, problem.what);
    }
  }
  return points;
}

const Keys<CurveTable>& curve_keys() {
  using C = CurveTable;
  static const auto keys = keys_of<C>("curve", [](auto& row) {
    row("svg", &C::svg, text(), "An SVG file.");
    row("obj", &C::obj, text(), "An OBJ file.");
    row("id", &C::id, text(), "The path, group or object in it; none: the first, or all of it.");
    row("spline", "an array of points [[x, y], …]", "A curve through these points.", {},
        [](C& curve, const Given& given) { curve.spline = points_of(given); });
    row("closed", &C::closed, truth(), "The spline returns to its first point.");
  });
  return keys;
}

// The file's name stands before what is wrong with it.
std::vector<Polyline> svg_curves(const fs::path& file, const std::string& id) {
  const std::string document = read_whole_text(file);
  try {
    return sizing::parse_svg(document, id);
  } catch (const Error& error) {
    throw Error(error.code, fmt::format("{}: {}", file.string(), error.what()));
  }
}

// One curve, wherever it is from; of an outline's several, those that lie in it are its `holes`.
Polyline single(std::vector<Polyline> lines, double metres, bool closed, std::vector<Polyline>* holes) {
  if (lines.empty() || (lines.size() != 1 && !holes))
    throw Problem{fmt::format("has {} subpaths; one is wanted", lines.size())};
  for (Polyline& line : lines) {
    for (dvec2& point : line.points) point *= metres;
    line.closed |= closed;
    line = sizing::without_repeats(std::move(line));
  }
  if (holes) holes->insert(holes->end(), lines.begin() + 1, lines.end());
  return std::move(lines[0]);
}

Polyline curve_of_table(const Given& given, bool closed, std::vector<Polyline>* holes) {
  CurveTable curve;
  const std::size_t before = given.reader->complaints();
  given.reader->read(curve_keys(), *given.node.as_table(), "a curve", curve);
  if (given.reader->complaints() != before) return {};
  if (!curve.svg.empty() && !curve.obj.empty()) throw Problem{"has 'svg' and 'obj'; take one of them out"};
  const fs::path& folder = given.folder;
  if (!curve.svg.empty())
    return single(svg_curves(folder / curve.svg, curve.id), given.metres, closed, nullptr);
  if (!curve.obj.empty())
    return single(holes ? sizing::read_obj_outline(folder / curve.obj, curve.id)
                        : sizing::read_obj_lines(folder / curve.obj, curve.id),
                  given.metres, closed, holes);
  if (!given.node.as_table()->contains("spline")) throw Problem{"has neither 'spline' nor 'svg' nor 'obj'"};
  return sizing::spline_through(curve.spline, closed || curve.closed);
}

// Where a table within it is wrong, that is complained of, and the curve is empty.
Polyline curve_of(const Given& given, bool closed, std::vector<Polyline>* holes = nullptr) {
  try {
    if (given.node.is_string())
      return single(sizing::parse_path(text_of(given)), given.metres, closed, nullptr);
    if (given.node.is_array()) return sizing::without_repeats({points_of(given), closed});
    if (given.node.is_table()) return curve_of_table(given, closed, holes);
  } catch (const Error& error) {
    throw Problem{error.what()};
  }
  throw Problem{"is no curve"};
}

// --- [sizing]

const Keys<PanelFile>& sizing_keys() {
  static const auto keys = [] {
    using O = sizing::SizingOptions;
    using R = sizing::FabricRange;
    using Form = sizing::Transition::Form;
    using Fold = sizing::FoldRule;
    Keys<PanelFile> all;
    Rows<PanelFile, O> row(all, "sizing", [](PanelFile& file) -> O& { return file.options; });
    row("transition", &O::form,
        enumeration<Form>({{"unit-free", Form::unit_free}, {"literal", Form::literal}}),
        "How the size grows away from a line.");
    row("fold", &O::fold_rule,
        enumeration<Fold>({{"complement", Fold::complement}, {"literal", Fold::literal}}),
        "The resolution at a fold.");
    row("floor", &O::floor, length({1e-6, 1e9}).allowing("0.001 mm or more"), "Nothing is meshed finer.");
    row("fold_offset", &O::fold_offset, length({0, 1e9}).allowing("0 (no lines beside folds) or more"),
        "How far the two lines beside a fold are from it.");
    row("gradation", &O::gradation, number({0.01, 0.5}).allowing("0.01 to 0.5"),
        "How much the size may grow a length.");
    row("seed", &O::seed, whole(0, 4294967295).allowing("a whole number from 0"),
        "Another seed, another mesh.");
    Rows<PanelFile, R> range(all, "sizing", [](PanelFile& file) -> R& { return file.range; });
    const auto bending = quantity({0, infinity}, sizing::parse_bending).allowing("N·m");
    const auto modulus = quantity({0, infinity}, sizing::parse_modulus).allowing("N/m²");
    const auto size = length({0, 1e9}).allowing("a length");
    range("B_min", &R::bending_min, bending, "Bending stiffness of the softest fabric.");
    range("B_max", &R::bending_max, bending, "Bending stiffness of the stiffest fabric.");
    range("E_min", &R::modulus_min, modulus, "Young's modulus of the softest fabric.");
    range("E_max", &R::modulus_max, modulus, "Young's modulus of the stiffest fabric.");
    range("r_min", &R::resolution_min, size, "The finest resolution.");
    range("r_max", &R::resolution_max, size, "The coarsest resolution.");
    return all;
  }();
  return keys;
}

void read_sizing(FileReader& reader, const toml::table& table, PanelFile& file) {
  reader.read(sizing_keys(), table, "[sizing]", file);
  try {
    file.options.law = sizing::resolution_law(file.range);
  } catch (const Error& error) {
    reader.complain(table.source().begin, error.what());
  }
}

// --- [[panel.feature]]

const Words<Rule>& rules() {
  static const Words<Rule> words = [] {
    Words<Rule> all;
    for (const Rule rule : {Rule::shirring, Rule::fold, Rule::stitch, Rule::cell, Rule::collision})
      all.push_back({name_of(rule), rule});
    return all;
  }();
  return words;
}

bool is_region(Rule rule) {
  return rule == Rule::cell || rule == Rule::collision;
}

const Keys<Feature>& feature_keys() {
  static const auto keys = [] {
    using F = Feature;
    using C = sizing::TransitionCause;
    Keys<F> all;
    Rows<F> row(all, "feature", [](F& feature) -> F& { return feature; });
    const std::vector<std::string> shortened = {"shirring", "cell", "collision"};
    const std::vector<std::string> stiffened = {"shirring", "stitch", "cell", "collision"};
    row("rule", &F::rule, enumeration(rules()), "What is done along the line.",
        {.needed = always, .first = true});
    row("name", &F::name, text(), "What reports call it.");
    row("line", curve_allowed, "Where it is done.", {.needed = always},
        [](F& feature, const Given& given) { feature.line = curve_of(given, is_region(feature.rule)); });
    row("ratio", &F::ratio, number({1e-3, 1}).allowing("contracted over rest length, 0.001 to 1 (none)"),
        "How much shorter the line becomes.", {.of = shortened});
    row("stiffness", &F::added_modulus,
        quantity({0, 1e15}, sizing::parse_modulus).allowing("0 or more, in N/m² or with a unit"),
        "What the seam adds to Young's modulus.", {.of = stiffened});
    row("exponent", &F::exponent, number({0, 100}).allowing("0 to 100"), "Of the ratio.", {.of = stiffened});
    row("angle", &F::angle, number({0, 360}).allowing("degrees from flat, 0 to 360"), "Of the fold.",
        {.of = {"fold"}, .needed = always});
    row("other_length", &F::other_length,
        length({1e-9, 1e9}).allowing("length of the line it is sewn to, above 0"), "Of the other side.",
        {.of = {"stitch"}, .needed = always});
    Rows<F, C> cause(all, "feature", [](F& feature) -> C& { return feature.cause; });
    cause("pressure", &C::pressure, number({0, 1e6}).allowing("0 or more"), "Of the filling.",
          {.of = {"cell"}});
    cause("tension", &C::tension, number({0, 1e9}).allowing("N/m, 0 or more"), "Across the line.");
    cause("transition", &C::prefactor,
          number({1e-6, 1e6}).allowing("factor on the transition's length, above 0"),
          "How far from the line the mesh is finer.");
    return all;
  }();
  return keys;
}

// --- [[panel]]

struct PanelTable {
  sizing::Panel panel;
  std::vector<Polyline> holes;  // those of the key; the outline's own come first
  sizing::Placement placement;
  bool placed = false;
};

void read_feature(FileReader& reader, const toml::table& table, std::vector<Feature>& features) {
  Feature feature;
  if (!reader.read_first(feature_keys(), table, "[[panel.feature]]", feature)) return;
  const std::string rule = name_of(feature.rule);
  feature.name = fmt::format("{}{}", rule, features.size() + 1);
  reader.read(feature_keys(), table, fmt::format("[[panel.feature]] of rule {}", rule), feature, rule);
  features.push_back(std::move(feature));
}

const Keys<PanelTable>& panel_keys() {
  static const auto keys = [] {
    using T = PanelTable;
    using P = sizing::Panel;
    Keys<T> all;
    Rows<T, P> row(all, "panel", [](T& table) -> P& { return table.panel; });
    row("name", "a text that can name files: not empty, no slashes, no dot in front",
        "What files and reports call it.", {}, [](P& panel, const Given& given) {
          panel.name = text_of(given);
          if (panel.name.empty() || panel.name.find_first_of("/\\\n") != std::string::npos ||
              panel.name.front() == '.')
            throw Problem{fmt::format("'{}' will not do", panel.name)};
        });
    row("grain", &P::grain, number({-360, 360}).allowing("degrees from x to the warp"), "The warp.");
    row("fabric", fabric(), "The panel's fabric; without it the file's.", {},
        [](P& panel, const std::optional<sizing::Fabric>& given) {
          if (given) panel.fabric = *given;
        });
    row("outline", curve_allowed, "The panel's edge.", {.needed = always},
        [](P& panel, const Given& given) { panel.outline = curve_of(given, true, &panel.holes); });
    row("feature", "tables [[panel.feature]]", "What is done along lines.", {},
        [](P& panel, const Given& given) {
          given.reader->read_each(given.node, "panel.feature", [&](const toml::table& table) {
            read_feature(*given.reader, table, panel.features);
          });
        });
    Rows<T> rest(all, "panel", [](T& table) -> T& { return table; });
    rest("holes", "an array of curves", "Closed curves that are cut out.", {},
         [](T& table, const Given& given) {
           if (!given.node.is_array()) throw Problem{"is no array of curves"};
           for (const toml::node& hole : *given.node.as_array())
             table.holes.push_back(curve_of(given.part(hole), true));
         });
    rest("translation", point(), "Where the panel's origin starts.", {}, [](T& table, const glm::dvec3& at) {
      table.placement.translation = at;
      table.placed = true;
    });
    // Round x, then y, then z, axes that do not turn with the panel.
    rest("rotation", vector("[x, y, z], degrees"), "How it is turned before that.", {},
         [](T& table, const glm::dvec3& degrees) {
           table.placement.rotation = sizing::turned_by(degrees);
           table.placed = true;
         });
    return all;
  }();
  return keys;
}

// --- [[seam]]

struct SideTable {
  std::string panel;
  sizing::SeamSide side;
};
struct SeamTable {
  sizing::Seam seam;
  SideTable a, b;
};

const Keys<SideTable>& side_keys() {
  static const auto keys = [] {
    using S = sizing::SeamSide;
    Keys<SideTable> all;
    Rows<SideTable> row(all, "side", [](SideTable& table) -> SideTable& { return table; });
    row("panel", &SideTable::panel, text().allowing("the name of a panel"), "The panel.", {.needed = always});
    Rows<SideTable, S> side(all, "side", [](SideTable& table) -> S& { return table.side; });
    const auto end = flat_point().allowing("a point [x, y] of the panel's outline, two lengths");
    side("from", &S::from, end, "Where the seam begins.", {.needed = always});
    side("to", &S::to, end, "Where it ends.", {.needed = always});
    side("long_way", &S::long_way, truth(), "The longer of the two ways between them.");
    return all;
  }();
  return keys;
}

void read_side(SideTable& side, const Given& given) {
  if (!given.node.is_table()) throw Problem{"is no table"};
  given.reader->read(side_keys(), *given.node.as_table(), "the side of a seam", side);
}

const Keys<SeamTable>& seam_keys() {
  using T = SeamTable;
  static const auto keys = [] {
    constexpr const char* allowed = "{ panel = NAME, from = [x, y], to = [x, y], long_way = true or false }";
    Keys<T> all;
    Rows<T, sizing::Seam> row(all, "seam", [](T& table) -> sizing::Seam& { return table.seam; });
    row("name", &sizing::Seam::name, text(), "What reports call it.");
    Rows<T> rest(all, "seam", [](T& table) -> T& { return table; });
    rest("a", allowed, "One side.", {.needed = always},
         [](T& table, const Given& given) { read_side(table.a, given); });
    rest("b", allowed, "The other.", {.needed = always},
         [](T& table, const Given& given) { read_side(table.b, given); });
    return all;
  }();
  return keys;
}

std::vector<std::string> panel_names(const sizing::Garment& garment) {
  std::vector<std::string> names;
  for (const sizing::Panel& panel : garment.panels) names.push_back(panel.name);
  return names;
}

void read_seam(FileReader& reader, const toml::table& table, sizing::Garment& garment) {
  const std::size_t before = reader.complaints();
  SeamTable seam;
  seam.seam.name = fmt::format("seam{}", garment.seams.size() + 1);
  reader.read(seam_keys(), table, "[[seam]]", seam);
  if (reader.complaints() != before) return;
  const auto names = panel_names(garment);
  for (const auto& [key, side] : {std::pair("a", &seam.a), std::pair("b", &seam.b)}) {
    const auto found = std::find(names.begin(), names.end(), side->panel);
    if (found == names.end())
      reader.complain(table[key]["panel"].node()->source().begin,
                      fmt::format("key 'panel': there is no panel '{}'; allowed: {}{}", side->panel,
                                  either(names), did_you_mean(side->panel, names)));
    side->side.panel = static_cast<std::size_t>(found - names.begin());
  }
  seam.seam.a = seam.a.side;
  seam.seam.b = seam.b.side;
  if (reader.complaints() == before) garment.seams.push_back(std::move(seam.seam));
}

// --- the file

struct Head {
  double metres = 1;
  bool has_fabric = false;
  sizing::Fabric fabric;  // of panels that have none of their own
};

const Keys<Head>& head_keys() {
  static const auto keys = keys_of<Head>("file", [](auto& row) {
    row("units", std::string(length_units), "Of lengths that are numbers; without it metres.",
        {.first = true}, [](Head& head, const Given& given) {
          const auto metres = parse_length("1 " + text_of(given));
          if (!metres) throw Problem{"is no unit"};
          head.metres = *metres;
        });
    row("fabric", fabric(), "Of all panels that have none of their own.", {},
        [](Head& head, const std::optional<sizing::Fabric>& given) {
          head.has_fabric = true;  // a wrong one is complained of once, not by every panel that misses it
          if (given) head.fabric = *given;
        });
  });
  return keys;
}

PanelFile read_panels(FileReader& reader, const sizing::Fabric* in_place) {
  PanelFile file;
  Head head;
  std::set<std::string> names;
  bool any_placed = false;
  reader.at_values = true;
  reader.read_first(head_keys(), reader.root(), "the file", head);
  reader.metres = head.metres;
  const auto read_panel = [&](const toml::table& table, const toml::source_position& at) {
    PanelTable item;
    sizing::Panel& panel = item.panel;
    panel.name = fmt::format("panel{}", file.garment.panels.size() + 1);
    if (in_place || head.has_fabric) panel.fabric = in_place ? *in_place : head.fabric;
    const Places places = reader.read(panel_keys(), table, "[[panel]]", item);
    if (!names.insert(panel.name).second)
      reader.complain(at, fmt::format("key 'name': there are two panels '{}'", panel.name));
    if (in_place) panel.fabric = *in_place;
    if (!in_place && !head.has_fabric && !places.contains("fabric"))
      reader.complain(at, "key 'fabric': missing; give it to the panel or above all panels");
    panel.holes.insert(panel.holes.end(), item.holes.begin(), item.holes.end());
    for (Feature& feature : panel.features) feature.cause.poisson_ratio = panel.fabric.poisson_ratio;
    any_placed |= item.placed;
    file.garment.placements.push_back(item.placement);
    file.garment.panels.push_back(std::move(panel));
  };
  reader.read_root(
      head_keys(), head,
      {{"sizing", false,
        [&](const toml::table& table, const toml::source_position&) { read_sizing(reader, table, file); }},
       {"panel", true, read_panel, true},
       {"seam", true, [&](const toml::table& table, const toml::source_position&) {
          read_seam(reader, table, file.garment);
        }}});
  if (!reader.root().contains("panel"))
    reader.complain(reader.root().source().begin,
                    "key 'panel': missing in the file; allowed: tables [[panel]]");
  if (!any_placed) file.garment.placements.clear();
  reader.finish();
  return file;
}

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
  FileReader reader(text, file);
  return read_panels(reader, fabric);
}

void keep_pieces(PanelFile& file, const std::vector<std::string>& names) {
  if (names.empty()) return;
  sizing::Garment& garment = file.garment;
  std::vector<std::string> known;
  for (const sizing::Panel& panel : garment.panels) known.push_back(panel.name);
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ExitCode::bad_input, fmt::format("there is no panel '{}'; allowed: {}{}", name,
                                                   either(known), did_you_mean(name, known)));
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
  const toml::table root = parse_toml(read_whole_text(file), file);
  return root.contains("panel") && !root.contains("model") && !root.contains("drape");
}

}  // namespace plisse::config
