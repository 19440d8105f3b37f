// What `plisse drape` solves: a shell from flat panels or a surface, sewn, held and loaded. Scene files, the
// TFW authors' set-ups and the built-in examples all become one of these.
//
// Metres, newtons, y up.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "shell/newton.h"
#include "shell/statics.h"

namespace plisse::cloth {

struct DrapeScene {
  std::string name;
  shell::Positions rest;                // may be cut apart where the base is sewn
  std::vector<shell::Face> rest_faces;  // into `rest`; face i, corner j belongs to base face i, corner j
  std::vector<shell::Face> faces;       // of the base surface
  bool rest_flat = false;               // bending is measured from the flat shape, also if `rest` is curved
  shell::Positions start;               // of the base surface
  bool chords = true;                   // WrinkleScene::chords of its base surface
  bool solved = false;                  // `start` is the solution (the base_mesh of a set-up for wrinkles)
  shell::Material material;
  shell::Stretching stretching = shell::Stretching::tension_field;
  shell::Bending bending = shell::Bending::quadratic;
  double residual = 0;
  double perturb = 0;  // m: free coordinates of the start are moved at random by up to this much
  shell::Loads loads;
  shell::Positions growing_forces;  // N, 3×V or empty: t times these are added to the loads'
  // The held coordinates at load t in 0 … 1. The same ones are held for every t.
  std::function<shell::Conditions(double t)> conditions;
  // Obstacles that move, at load t; the same number for every t. Empty: those of `loads` stay.
  std::function<std::vector<shell::Obstacle>(double t)> obstacles;
  int frames = 1;  // of a scene that moves: frame n of N stands at t = (n − 1)/(N − 1)
  // Measures of the result, by name; none where empty.
  std::function<std::map<std::string, double>(const shell::Positions&)> measures;
  shell::NewtonSettings newton;
};

}  // namespace plisse::cloth
