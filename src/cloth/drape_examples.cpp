#include "cloth/drape_examples.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/error.h"
#include "cloth/drape_mesh.h"
#include "cloth/drape_skirt.h"
#include "config/suggest.h"
#include "shell/fundamental_forms.h"

namespace plisse::cloth {
namespace {

using Eigen::Vector3d;
using shell::Bending;
using shell::Conditions;
using shell::Positions;
using shell::Stretching;
using std::numbers::pi;

constexpr double gravity = 9.81;  // m/s²

struct Wanted {
  int vertices;
  std::uint32_t seed;
};

// A flat panel that is its own base, in the plane z = 0.
DrapeScene panel_scene(const FlatMesh& mesh) {
  DrapeScene scene;
  scene.rest = scene.start = mesh.points;
  scene.rest_faces = scene.faces = mesh.faces;
  return scene;
}

// `sewn`: how much of its outline will be.
FlatMesh rectangle(double width, double height, const Wanted& wanted, double sewn = 0) {
  return delaunay_mesh(rectangle_outline(width, height), {}, wanted.vertices, wanted.seed, sewn);
}

// The vertex nearest to a point.
std::uint32_t nearest(const Positions& positions, const Vector3d& point) {
  Eigen::Index index = 0;
  (positions.colwise() - point).colwise().squaredNorm().minCoeff(&index);
  return static_cast<std::uint32_t>(index);
}

std::vector<std::uint32_t> vertices_where(const Positions& positions, const auto& is) {
  std::vector<std::uint32_t> found;
  for (Eigen::Index v = 0; v < positions.cols(); ++v)
    if (is(Vector3d(positions.col(v)))) found.push_back(static_cast<std::uint32_t>(v));
  return found;
}

// --- plane strips
// -------------------------------------------------------------------------------------------

// Both short sides move apart by `share` of the length and stay straight; free to contract, or clamped.
DrapeScene stretched(const Wanted& wanted, double width, double height, double share, bool clamped) {
  DrapeScene scene = panel_scene(rectangle(width, height, wanted));
  const Positions rest = scene.rest;
  const double tiny = 1e-5 * width;
  scene.frames = 24;
  scene.conditions = [=](double t) {
    Conditions conditions(static_cast<std::size_t>(rest.cols()));
    for (std::uint32_t v = 0; v < rest.cols(); ++v) {
      const bool left = rest(0, v)<tiny, right = rest(0, v)> width - tiny;
      if (left) conditions.hold(v, 0, 0);
      if (right) conditions.hold(v, 0, width * (1 + share * t));
      if (clamped && (left || right)) {
        conditions.hold(v, 1, rest(1, v));
        conditions.hold(v, 2, 0);
      }
      if (!clamped) conditions.hold(v, 2, 0);
    }
    if (!clamped) conditions.hold(nearest(rest, Vector3d(0, 0, 0)), 1, 0);
    return conditions;
  };
  return scene;
}

DrapeScene strip(const Wanted& wanted) {
  DrapeScene scene = stretched(wanted, 0.25, 0.1, 0.1, false);
  scene.material = {1e6, 0.3, 1e-4, 0};
  scene.measures = [](const Positions& x) {
    return std::map<std::string, double>{{"width_m", x.row(1).maxCoeff() - x.row(1).minCoeff()}};
  };
  return scene;
}

DrapeScene stretched_sheet(const Wanted& wanted) {
  DrapeScene scene = stretched(wanted, 0.25, 0.1, 0.1, true);
  scene.material = {1e6, 0.5, 1e-4, 0};
  return scene;
}

// The same, of which only the quarter x ≥ 0, y ≥ 0 about its middle is solved: waves are mirror-symmetric in
// both planes.
DrapeScene stretched_quarter(const Wanted& wanted) {
  const double width = 0.125, height = 0.05, share = 0.1, tiny = 1e-5 * width;
  DrapeScene scene = panel_scene(rectangle(width, height, wanted));
  scene.material = {1e6, 0.5, 1e-4, 0};
  const Positions rest = scene.rest;
  scene.frames = 24;
  scene.conditions = [=](double t) {
    Conditions conditions(static_cast<std::size_t>(rest.cols()));
    for (std::uint32_t v = 0; v < rest.cols(); ++v) {
      if (rest(0, v) < tiny) conditions.hold(v, 0, 0);
      if (rest(1, v) < tiny) conditions.hold(v, 1, 0);
      if (rest(0, v) > width - tiny) conditions.hold(v, Vector3d(width * (1 + share * t), rest(1, v), 0));
    }
    conditions.mirrors = {{0, 0}, {1, 0}};
    return conditions;
  };
  scene.measures = [](const Positions& x) {
    return std::map<std::string, double>{{"amplitude_m", x.row(2).cwiseAbs().maxCoeff()}};
  };
  return scene;
}

// Wong & Pellegrino 2006: Kapton between two clamped long sides, sheared by 3 mm; a little prestress.
DrapeScene sheared_rectangle(const Wanted& wanted) {
  const double width = 0.38, height = 0.128, shear = 3e-3, prestress = 5e-5;
  DrapeScene scene = panel_scene(rectangle(width, height, wanted));
  scene.material = {3.5e9, 0.31, 25e-6, 0};
  const Positions rest = scene.rest;
  scene.frames = 24;
  scene.conditions = [=](double t) {
    Conditions conditions(static_cast<std::size_t>(rest.cols()));
    for (std::uint32_t v = 0; v < rest.cols(); ++v) {
      if (rest(1, v) < 1e-5 * height) conditions.hold(v, rest.col(v));
      if (rest(1, v) > height * (1 - 1e-5))
        conditions.hold(v, rest.col(v) + Vector3d(shear * t, prestress, 0));
    }
    return conditions;
  };
  return scene;
}

// --- the twisted cylinder
// -----------------------------------------------------------------------------------

constexpr double cylinder_radius = 1, cylinder_height = 5, cylinder_twist = 10 * pi / 180;

DrapeScene twisted_cylinder_of(const FlatMesh& mesh) {
  const double around = 2 * pi * cylinder_radius, tiny = 1e-5 * around;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> seam;
  const auto left = vertices_where(mesh.points, [&](const Vector3d& p) { return p.x() < tiny; });
  const auto right = vertices_where(mesh.points, [&](const Vector3d& p) { return p.x() > around - tiny; });
  for (const std::uint32_t l : left)
    for (const std::uint32_t r : right)
      if (std::abs(mesh.points(1, l) - mesh.points(1, r)) < tiny) seam.emplace_back(l, r);
  const Sewn sewn = sew(static_cast<std::size_t>(mesh.points.cols()), mesh.faces, seam);
  if (seam.size() != left.size() || left.size() != right.size())
    throw Error(ExitCode::bad_input,
                "the cylinder's seam has vertices without a partner; take another --seed");
  DrapeScene scene;
  scene.rest = mesh.points;
  scene.rest_faces = mesh.faces;
  scene.faces = sewn.faces;
  scene.material = {1e7, 0.44, 1e-4, 0};
  Positions unrolled(3, sewn.count);
  for (std::uint32_t v = 0; v < mesh.points.cols(); ++v) unrolled.col(sewn.base_of[v]) = mesh.points.col(v);
  const auto rolled = [=](std::uint32_t v, double twist) {
    const double angle = unrolled(0, v) / cylinder_radius + twist * unrolled(1, v) / cylinder_height;
    return Vector3d(cylinder_radius * std::cos(angle), unrolled(1, v), -cylinder_radius * std::sin(angle));
  };
  scene.start.resize(3, sewn.count);
  for (std::uint32_t v = 0; v < sewn.count; ++v) scene.start.col(v) = rolled(v, 0);
  scene.frames = 24;
  scene.conditions = [=](double t) {
    Conditions conditions(sewn.count);
    for (std::uint32_t v = 0; v < sewn.count; ++v)
      if (unrolled(1, v) < tiny || unrolled(1, v) > cylinder_height - tiny)
        conditions.hold(v, rolled(v, cylinder_twist * t));
    return conditions;
  };
  scene.measures = [](const Positions& x) {
    return std::map<std::string, double>{
        {"waist_radius_m", std::sqrt((x.row(0).array().square() + x.row(2).array().square()).minCoeff())}};
  };
  return scene;
}

DrapeScene twisted_cylinder(const Wanted& wanted) {
  return twisted_cylinder_of(
      rectangle(2 * pi * cylinder_radius, cylinder_height, wanted, 2 * cylinder_height));
}

DrapeScene regular_cylinder(const Wanted& wanted, Diagonals diagonals) {
  const int columns = std::max(
      6,
      static_cast<int>(std::lround(std::sqrt(wanted.vertices * 2 * pi * cylinder_radius / cylinder_height))));
  const int rows =
      std::max(2, static_cast<int>(std::lround(static_cast<double>(wanted.vertices) / columns)) - 1);
  return twisted_cylinder_of(grid_mesh(2 * pi * cylinder_radius, cylinder_height, columns, rows, diagonals));
}

// --- two alike panels, sewn along their outlines, blown up
// ----------------------------------------------------

// An edge across the panel between two seam vertices would be sewn to the same edge of the other panel: it is
// split in its middle. Returns whether there was one; edges of the same triangle need another call.
bool split_some_chords(FlatMesh& mesh, const std::vector<std::uint32_t>& seam) {
  std::vector<bool> on_seam(static_cast<std::size_t>(mesh.points.cols()), false);
  for (const std::uint32_t v : seam) on_seam[v] = true;
  const auto topology = shell::build_topology(mesh.faces, on_seam.size());
  std::vector<bool> split(mesh.faces.size(), false);  // a triangle is split once; others of its edges stay
  for (const shell::Edge& edge : topology.edges) {
    if (edge.boundary() || !on_seam[edge.vertex[0]] || !on_seam[edge.vertex[1]]) continue;
    if (split[edge.face[0]] || split[edge.face[1]]) continue;
    const auto middle = static_cast<std::uint32_t>(mesh.points.cols());
    mesh.points.conservativeResize(3, middle + 1);
    mesh.points.col(middle) = 0.5 * (mesh.points.col(edge.vertex[0]) + mesh.points.col(edge.vertex[1]));
    for (const std::uint32_t f : edge.face) {
      split[f] = true;
      shell::Face other = mesh.faces[f];
      for (std::uint32_t& v : mesh.faces[f])
        if (v == edge.vertex[0]) v = middle;
      for (std::uint32_t& v : other)
        if (v == edge.vertex[1]) v = middle;
      mesh.faces.push_back(other);
    }
  }
  return std::find(split.begin(), split.end(), true) != split.end();
}

// The panels lie in the plane y = 0 and bulge apart; seams stay in that plane, of which the whole is a mirror
// image. Three more held coordinates remove the remaining rigid motions, without constraining the symmetric
// shape.
DrapeScene pillow(FlatMesh mesh, const std::vector<std::uint32_t>& seam, double bulge) {
  while (split_some_chords(mesh, seam)) {
  }
  const auto count = static_cast<std::uint32_t>(mesh.points.cols());
  DrapeScene scene;
  scene.rest.resize(3, 2 * count);
  scene.rest << mesh.points, mesh.points;
  scene.rest_faces = mesh.faces;
  for (const shell::Face& face : mesh.faces)
    scene.rest_faces.push_back({face[0] + count, face[2] + count, face[1] + count});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  std::vector<bool> sewn_here(count, false);
  for (const std::uint32_t v : seam) {
    pairs.emplace_back(v, v + count);
    sewn_here[v] = true;
  }
  const Sewn sewn = sew(2 * static_cast<std::size_t>(count), scene.rest_faces, pairs);
  scene.faces = sewn.faces;
  scene.start.resize(3, sewn.count);
  for (std::uint32_t v = 0; v < 2 * count; ++v) {
    const Vector3d p = mesh.points.col(v % count);
    // Raised toward the middle, so that the start is not flat; faces of both panels are counterclockwise from
    // outside.
    double distance = std::numeric_limits<double>::max();
    for (const std::uint32_t s : seam) distance = std::min(distance, (mesh.points.col(s) - p).norm());
    const double rise = sewn_here[v % count] ? 0 : bulge * std::sqrt(distance);
    scene.start.col(sewn.base_of[v]) << 0.9 * p.x(), v < count ? rise : -rise, -0.9 * p.y();
  }
  const Positions flat = scene.start;
  std::vector<std::uint32_t> held;
  for (const std::uint32_t v : seam) held.push_back(sewn.base_of[v]);
  const auto extreme = [&](const Vector3d& way) {
    return *std::max_element(held.begin(), held.end(), [&](std::uint32_t a, std::uint32_t b) {
      return way.dot(flat.col(a)) < way.dot(flat.col(b));
    });
  };
  const std::uint32_t east = extreme({1, 0, 0}), west = extreme({-1, 0, 0}), north = extreme({0, 0, 1});
  scene.conditions = [=, total = sewn.count](double) {
    Conditions conditions(total);
    for (const std::uint32_t v : held) conditions.hold(v, 1, 0);
    conditions.hold(east, 2, flat(2, east));
    conditions.hold(west, 2, flat(2, west));
    conditions.hold(north, 0, flat(0, north));
    return conditions;
  };
  scene.measures = [faces = scene.faces, held](const Positions& x) {
    double radius = 0;
    for (const std::uint32_t v : held)
      radius += std::hypot(x(0, v), x(2, v)) / static_cast<double>(held.size());
    return std::map<std::string, double>{{"radius_m", radius},
                                         {"thickness_m", x.row(1).maxCoeff() - x.row(1).minCoeff()},
                                         {"volume_m3", shell::enclosed_volume(faces, x)}};
  };
  return scene;
}

DrapeScene disk_balloon(const Wanted& wanted) {
  const double radius = 0.1;
  const FlatMesh mesh =
      delaunay_mesh(circle_outline(radius, 720), {}, wanted.vertices / 2, wanted.seed, 2 * pi * radius);
  const auto rim =
      vertices_where(mesh.points, [&](const Vector3d& p) { return p.norm() > radius * (1 - 1e-4); });
  DrapeScene scene = pillow(mesh, rim, 0.1);
  scene.material = {1e7, 0.44, 1e-4, 0};
  scene.loads.pressure = 10;
  return scene;
}

DrapeScene torus(const Wanted& wanted) {
  const double inner = 0.04, outer = 0.1;
  const FlatMesh mesh = delaunay_mesh(circle_outline(outer, 720), {circle_outline(inner, 360)},
                                      wanted.vertices / 2, wanted.seed, 2 * pi * (outer + inner));
  const auto rims = vertices_where(mesh.points, [&](const Vector3d& p) {
    return p.norm() > outer * (1 - 1e-4) || p.norm() < inner * (1 + 1e-4);
  });
  DrapeScene scene = pillow(mesh, rims, 0.1);
  scene.material = {1e7, 0.44, 1e-4, 0};
  scene.loads.pressure = 100;
  // Without stiffness against compression the energy is lower with kinks, in which all compression is
  // concentrated.
  scene.residual = 1e-3;
  return scene;
}

DrapeScene teabag(const Wanted& wanted) {
  const double width = 1.4, height = 0.74;
  FlatMesh mesh = rectangle(width, height, {wanted.vertices / 2, wanted.seed}, 2 * (width + height));
  mesh.points.colwise() -= Vector3d(width / 2, height / 2, 0);
  const auto rim = vertices_where(mesh.points, [&](const Vector3d& p) {
    return std::abs(p.x()) > width / 2 * (1 - 1e-5) || std::abs(p.y()) > height / 2 * (1 - 1e-5);
  });
  DrapeScene scene = pillow(mesh, rim, 0.3);
  scene.material = {1e5, 0.3, 1e-3, 0};
  scene.loads.pressure = 5;
  return scene;
}

// --- cloth that hangs
// -----------------------------------------------------------------------------------------

// Turns a panel's y into −z: it lies flat, its normal upward.
Positions laid_flat(const Positions& panel) {
  Positions flat = panel;
  flat.row(2) = -panel.row(1);
  flat.row(1).setZero();
  return flat;
}

DrapeScene sphere_drape(const Wanted& wanted) {
  const double side = 1, radius = 0.2, gap = 2e-3;
  FlatMesh mesh = rectangle(side, side, wanted);
  mesh.points.colwise() -= Vector3d(side / 2, side / 2, 0);
  DrapeScene scene = panel_scene(mesh);
  scene.material = {1e5, 0.3, 1e-3, 200};
  scene.loads.gravity << 0, -gravity, 0;
  scene.loads.obstacles = {shell::Sphere{{0, -radius - gap / 2, 0}, radius}};
  scene.loads.gap = gap;
  scene.start = laid_flat(mesh.points);
  // Without friction it would slide off: its middle stays on the axis, and it does not turn about it.
  const std::uint32_t middle = nearest(scene.start, Vector3d::Zero());
  const std::uint32_t side_vertex = nearest(scene.start, Vector3d(0.4, 0, 0));
  const Positions start = scene.start;
  scene.conditions = [=](double) {
    Conditions conditions(static_cast<std::size_t>(start.cols()));
    conditions.hold(middle, 0, start(0, middle));
    conditions.hold(middle, 2, start(2, middle));
    conditions.hold(side_vertex, 2, start(2, side_vertex));
    return conditions;
  };
  scene.measures = [=](const Positions& x) {
    const double low = (x.colwise() - Vector3d(0, -radius - gap / 2, 0)).colwise().norm().minCoeff();
    return std::map<std::string, double>{{"nearest_to_obstacle_m", low - radius},
                                         {"drop_m", -x.row(1).minCoeff()}};
  };
  return scene;
}

// Held by nine hooks that come together to three quarters of the width.
DrapeScene curtain(const Wanted& wanted) {
  const double width = 1.6, height = 1.2;
  const int hooks = 9;
  DrapeScene scene = panel_scene(rectangle(width, height, wanted));
  scene.material = {1e5, 0.3, 5e-4, 400};
  scene.loads.gravity << 0, -gravity, 0;
  std::vector<std::uint32_t> hooked;
  for (int k = 0; k < hooks; ++k)
    hooked.push_back(nearest(scene.rest, Vector3d(width * k / (hooks - 1), height, 0)));
  // A slight wave, with alternating signs between the hooks: the flat cloth is in equilibrium too.
  for (Eigen::Index v = 0; v < scene.start.cols(); ++v)
    scene.start(2, v) = 0.05 * std::sin(pi * (hooks - 1) * scene.start(0, v) / width);
  const Positions rest = scene.rest;
  scene.frames = 24;
  scene.conditions = [=](double t) {
    Conditions conditions(static_cast<std::size_t>(rest.cols()));
    for (const std::uint32_t v : hooked)
      conditions.hold(v, Vector3d(width / 2 + (rest(0, v) - width / 2) * (1 - 0.25 * t), height, 0));
    return conditions;
  };
  return scene;
}

// The heavy elastica of "Known answers": G = wL³/B = 5, tip drop 0.495905 L.
DrapeScene cantilever(const Wanted& wanted) {
  const double length = 1;
  const int columns = std::max(8, wanted.vertices / 3 - 1);
  // A hinge represents the bending of half an edge on each side of it: so the last held column of vertices is
  // half an edge before the beginning of the free length.
  const double edge = length / (columns - 0.5);
  DrapeScene scene = panel_scene(grid_mesh(columns * edge, 0.1, columns, 2, Diagonals::alternating));
  scene.material = {1e7, 0, 1e-3, 1000};
  scene.stretching = Stretching::stvk;
  scene.bending = Bending::midedge;
  scene.start = laid_flat(scene.rest);
  const double weight = scene.material.density * scene.material.thickness;
  scene.loads.gravity << 0, -5 * scene.material.bending_stiffness() / (weight * length * length * length), 0;
  const Positions start = scene.start;
  scene.conditions = [=](double) {
    Conditions conditions(static_cast<std::size_t>(start.cols()));
    for (std::uint32_t v = 0; v < start.cols(); ++v)
      if (start(0, v) < 1.5 * edge) conditions.hold(v, start.col(v));
    return conditions;
  };
  scene.measures = [](const Positions& x) {
    Eigen::Index tip = 0;
    x.row(0).maxCoeff(&tip);
    return std::map<std::string, double>{{"tip_drop_m", -x.row(1).minCoeff()}};
  };
  return scene;
}

// A ring pulled inward at its inner edge three times as hard, a length, as outward at its outer one, ten
// times as far out: the ring is wrinkled out to 1.535 inner radii.
DrapeScene annulus(const Wanted& wanted) {
  const double inner = 0.1, outer = 1, ratio = 3;
  const double growth = std::log(outer / inner);
  const int around =
      std::max(12, static_cast<int>(std::lround(std::sqrt(wanted.vertices * 2 * pi / growth))));
  const int rings = std::max(4, static_cast<int>(std::lround(growth * around / (2 * pi))));
  const auto id = [&](int i, int j) {
    return static_cast<std::uint32_t>(j * around + (i + around) % around);
  };
  FlatMesh mesh;
  mesh.points.resize(3, around * (rings + 1));
  for (int j = 0; j <= rings; ++j)
    for (int i = 0; i < around; ++i) {
      const double radius = inner * std::exp(growth * j / rings),
                   angle = 2 * pi * (i + 0.5 * (j % 2)) / around;
      mesh.points.col(id(i, j)) << radius * std::cos(angle), radius * std::sin(angle), 0;
    }
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < around; ++i) {
      const int shift = j % 2;  // the ring above starts half a step later or earlier
      mesh.faces.push_back({id(i, j), id(i + shift, j + 1), id(i + 1, j)});
      mesh.faces.push_back({id(i + 1, j), id(i + shift, j + 1), id(i + shift + 1, j + 1)});
    }
  for (shell::Face& face : mesh.faces) std::swap(face[1], face[2]);  // counterclockwise
  DrapeScene scene = panel_scene(mesh);
  scene.material = {1e9, 0.3, 1e-4, 0};
  const double pull = 1e-5 * scene.material.young * scene.material.thickness;  // N/m, at the outer edge
  scene.loads.forces = Positions::Zero(3, mesh.points.cols());
  for (int i = 0; i < around; ++i) {
    for (const int j : {0, rings}) {
      const std::uint32_t v = id(i, j);
      const double share = 2 * pi * mesh.points.col(v).norm() / around;
      scene.loads.forces.col(v) = (j == 0 ? -ratio : 1.0) * pull * share * mesh.points.col(v).normalized();
    }
  }
  // The different lengths of the edges leave no net force: the forces of each edge sum to zero.
  const Positions rest = scene.rest;
  const std::uint32_t east = nearest(rest, {inner, 0, 0}), west = nearest(rest, {-inner, 0, 0}),
                      north = nearest(rest, {0, inner, 0});
  scene.conditions = [=](double) {
    Conditions conditions(static_cast<std::size_t>(rest.cols()));
    for (std::uint32_t v = 0; v < rest.cols(); ++v) conditions.hold(v, 2, 0);
    conditions.hold(east, 1, rest(1, east));
    conditions.hold(west, 1, rest(1, west));
    conditions.hold(north, 0, rest(0, north));
    return conditions;
  };
  const auto triangles = shell::rest_faces(scene.rest, scene.rest_faces);
  scene.measures = [=, faces = scene.faces, material = scene.material](const Positions& x) {
    double reach = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto strain = shell::principal_strain(triangles[f], shell::corners_of(faces[f], x));
      if (shell::tension_state(material, strain.value[0], strain.value[1]) != shell::TensionState::wrinkled)
        continue;
      const Vector3d middle = shell::corners_of(faces[f], rest).rowwise().mean();
      reach = std::max(reach, middle.norm());
    }
    return std::map<std::string, double>{{"wrinkled_radius_ratio", reach / inner}};
  };
  return scene;
}

struct Maker {
  DrapeExample example;
  DrapeScene (*make)(const Wanted&);
};

const std::vector<Maker>& makers() {
  static const std::vector<Maker> all = {
      {{"strip", "a strip pulled by a tenth, free to contract", 300}, strip},
      {{"stretched-sheet", "the same between clamps (fig. 7)", 522}, stretched_sheet},
      {{"stretched-sheet-quarter", "a quarter of it, up to its planes of symmetry (fig. 7)", 1000},
       stretched_quarter},
      {{"sheared-rectangle", "Kapton foil sheared by 3 mm (fig. 9)", 1000}, sheared_rectangle},
      {{"twisted-cylinder", "a tube twisted by 10 degrees, irregular mesh (fig. 21)", 688}, twisted_cylinder},
      {{"twisted-cylinder-rising", "the same, regular mesh, diagonals along the tension lines", 688},
       [](const Wanted& wanted) { return regular_cylinder(wanted, Diagonals::rising); }},
      {{"twisted-cylinder-falling", "the same, diagonals across them", 688},
       [](const Wanted& wanted) { return regular_cylinder(wanted, Diagonals::falling); }},
      {{"disk-balloon", "two discs sewn and blown up: the mylar balloon (fig. 12)", 2000}, disk_balloon},
      {{"torus", "two annuli sewn and blown up", 2000}, torus},
      {{"teabag", "two rectangles sewn and blown up", 936}, teabag},
      {{"annulus", "a ring pulled harder at its inner edge", 1000}, annulus},
      {{"sphere-drape", "a square of cloth over a sphere (fig. 5)", 1600}, sphere_drape},
      {{"curtain", "cloth on nine hooks that come together", 1500}, curtain},
      {{"skirt", "four panels, gathered at the waist, on a body that sways", 2500},
       [](const Wanted& wanted) { return skirt_scene(wanted.vertices, wanted.seed); }},
      {{"cantilever", "a plate strip under its own weight, St. Venant-Kirchhoff shell", 123}, cantilever},
  };
  return all;
}

}  // namespace

const std::vector<DrapeExample>& drape_examples() {
  static const std::vector<DrapeExample> all = [] {
    std::vector<DrapeExample> examples;
    for (const Maker& maker : makers()) examples.push_back(maker.example);
    return examples;
  }();
  return all;
}

DrapeScene drape_example(const std::string& name, int vertices, std::uint32_t seed) {
  std::vector<std::string> names;
  for (const Maker& maker : makers()) {
    names.push_back(maker.example.name);
    if (maker.example.name != name) continue;
    DrapeScene scene = maker.make({vertices > 0 ? vertices : maker.example.vertices, seed});
    scene.name = name;
    return scene;
  }
  throw Error(ExitCode::bad_input, fmt::format("there is no example '{}'{}; there are {}", name,
                                               config::did_you_mean(name, names), fmt::join(names, ", ")));
}

}  // namespace plisse::cloth
