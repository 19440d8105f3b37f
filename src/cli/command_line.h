// The command line: its commands, their options, and which one was meant. Plain types only: CLI11, which
// reads it, is a library of headers that takes long to compile, so command_line.cpp alone knows it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"

namespace plisse::cli {

// A description for --help, which is printed as it is, beside a column for the options.
inline std::string described(std::string_view text) {
  return wrapped(text, 76);
}

// How an option that takes several values is given them.
enum class Values {
  one_each_time,  // --only shirt --only sleeve
  with_commas,    // --aov height,normal; and more than once
  many,           // bench quick relaxation; and more than once
  all_given,      // as `many`, and nothing that is given is left out
  two,            // --evaluate AMPLITUDE DPHI
};

// What one command adds to the command line. Options are named "-o,--output", or "input" for one that is told
// by its place on the line; `value` is what --help calls the value. Each keeps a reference to what it fills
// in, which must live until the line has been read; what is not given stays as it was.
class CommandOptions {
 public:
  struct Implementation;
  explicit CommandOptions(std::unique_ptr<Implementation> implementation);
  ~CommandOptions();

  void add(const std::string& names, std::string& text, const std::string& value, const std::string& help);
  void add(const std::string& names, std::vector<std::string>& texts, Values values, const std::string& value,
           const std::string& help);
  // A number from `low` to `high`.
  void add(const std::string& names, double& number, double low, double high, const std::string& value,
           const std::string& help);
  void flag(const std::string& names, bool& given, const std::string& help);
  void hidden_flag(const std::string& names, bool& given);  // --help is silent about it

  // The headline that --help prints above the options added from here on; "": its usual one.
  void set_headline(const std::string& headline) { headline_ = headline; }

  std::string command() const;  // "render"

  std::function<int()> run;  // what the command does → exit code; throws Error

 private:
  friend class CommandLine;
  std::unique_ptr<Implementation> implementation_;
  std::string headline_;
};

class CommandLine {
 public:
  CommandLine();
  ~CommandLine();

  // A new command. `footer` stands below its --help; without one, the program's own does.
  CommandOptions& command(const std::string& name, const std::string& what, const std::string& footer = "");

  // Reads the line and runs the command that it names, or prints what --help and --version ask for; → exit
  // code. Throws Error(bad_input) that says which option or command is unknown and what may have been meant.
  int run(int argc, const char* const* argv);

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace plisse::cli
