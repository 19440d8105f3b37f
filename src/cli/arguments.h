// Arguments that several commands share.
#pragma once

#include <deque>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

#include "base/progress.h"
#include "cli/command_line.h"
#include "config/settings.h"
#include "pipeline/render.h"

namespace plisse::cli {

// A number above 0; a whole number in low … high. Throw Error(bad_input) that names the option.
double positive_number(const std::string& option, const std::string& text);
int whole_number(const std::string& option, const std::string& text, int low, int high);
// Several whole numbers, separated by commas.
std::vector<int> whole_numbers(const std::string& option, const std::string& text, int low, int high);

// Throws Error(bad_input) that names the first of these options that was given: its text goes on "has no
// effect …".
struct GivenOption {
  const char* name;
  bool given;
};
void refuse_without_effect(std::initializer_list<GivenOption> options, const std::string& why);

// --threads, -q, -v, --json.
class CommonArguments {
 public:
  explicit CommonArguments(CommandOptions& options);
  // Sets log level and thread limit; the limit holds as long as this object lives.
  void apply();

  bool quiet() const { return quiet_; }
  const std::string& json() const { return json_; }
  // Standard output is free for people unless the report goes there.
  bool tables_wanted() const { return !quiet_ && json_ != "-"; }

 private:
  bool quiet_ = false, verbose_ = false;
  std::string threads_, json_;
  std::shared_ptr<void> thread_limit_;
};

// SCENE.toml|MODEL and those options that override a scene's keys of which `wanted` says so.
class SceneArguments {
 public:
  using Wanted = std::function<bool(const std::string& option)>;
  explicit SceneArguments(
      CommandOptions& options, const Wanted& wanted = [](const std::string&) { return true; });
  // Reads the scene, or takes the defaults for a bare model, and applies the options.
  config::SceneSettings settings() const;

 private:
  struct Given {
    std::string option;
    std::vector<std::string> values;
  };
  std::string command_;
  std::string input_;
  bool solve_ = false;
  std::deque<Given> given_;  // a deque: the command line keeps references to its elements
};

// For commands that make no picture: whether an option of render's counts there too.
bool decides_geometry(const std::string& option);

// --device and --list-devices.
class DeviceArguments {
 public:
  explicit DeviceArguments(CommandOptions& options);
  bool list_wanted() const { return list_; }
  void list() const;
  int device() const;  // −1: the first that works

 private:
  bool list_ = false;
  std::string device_;
};

// Shows the frames of a run as they are done.
pipeline::FrameCallback frame_progress(Progress& progress);

}  // namespace plisse::cli
