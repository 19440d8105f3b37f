// The frames of a selection, and the file of each.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plisse::config {

// first, first + step, … ≤ last, counted from 1.
struct FrameRange {
  int first = 1, last = 1, step = 1;
};

// "1-48x2,60", "a..b", or any of these separated by commas; ranges are inclusive, "x2" takes every second
// one. Throws Error(bad_input) that names the part that is wrong.
std::vector<FrameRange> parse_frames(std::string_view selection);

// Frames picked by a selection out of 1…count, ascending, each once; an empty selection: all.
// Throws Error(bad_input) for a frame past the end, naming the range there is.
std::vector<int> select_frames(const std::string& selection, int count);

// "dir", "img_####.png", "img_%04d.png", "img_{frame:04}.png" → the file of a frame; a folder gets
// frame_####.png. Only the last part of the path is a pattern, it gets ".png" where it has no extension; a
// name that ends in .png without a place for the number is that one file for every frame.
std::string frame_path(const std::string& pattern, int frame);

// The file of a frame by a pattern of any other kind ("mesh_####.ply"); a name without a place for the number
// is that one file.
std::string numbered_path(const std::string& pattern, int frame);

// Whether the last part of the path has a place for a frame's number.
bool is_frame_pattern(const std::string& path);

// The same of a file to read: a pattern, and not a file that is called so.
bool names_many_files(const std::filesystem::path& path);

// Throws Error(bad_input) where frame_path would give another image format than PNG.
void check_frame_pattern(const std::string& pattern);

// Throws Error(bad_input) where two of these frames would have the same file, with a pattern that would be
// right.
void check_frame_paths(const std::string& pattern, std::span<const int> frames);

}  // namespace plisse::config
