// Progress of a run on stderr: a bar on a terminal, one line a step elsewhere, nothing with -q.
#pragma once

#include <string>
#include <string_view>

namespace plisse {

// "[=====>    ] 12/72  31.2 fps  eta 0:02", cut to `columns`. `seconds` went into the steps done so far;
// before the first there is neither fps nor eta.
std::string progress_bar(int done, int total, double seconds, int columns);

// "12/72  frames/frame_0012.png  31.2 fps  eta 0:02".
std::string progress_line(int done, int total, double seconds, std::string_view what);

class Progress {
 public:
  enum class Style { none, lines, bar };
  // A bar where stderr is a terminal, lines elsewhere.
  static Style style_for_stderr(bool quiet);

  explicit Progress(Style style);
  // Ends the bar's line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // After a step; `what` names it. From one thread.
  void update(int done, int total, std::string_view what);

  // Clears the bar on the terminal's last line, if there is one, so that a message has the line to itself;
  // the next update draws it again. From any thread (base/log.cpp).
  static void wipe();

 private:
  Style style_;
  double start_, drawn_ = 0;  // wall_seconds()
};

}  // namespace plisse
