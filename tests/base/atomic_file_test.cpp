// Whole or not at all: every way of failing must leave the old file, no litter, and a sentence with path and
// reason.
#include "base/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <string>
#include <thread>

#include "base/error.h"
#include "support/files.h"

namespace plisse {
namespace {

namespace fs = std::filesystem;

class WholeFile : public testing::Test {
 protected:
  static std::string text_of(const fs::path& path) {
    const auto bytes = read_whole_file(path);
    return {bytes.begin(), bytes.end()};
  }
  static std::size_t entries(const fs::path& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
  static void expect_no_output(const fs::path& path, const std::string& reason) {
    try {
      write_whole_file(path, std::string(100000, 'x'));
      FAIL() << path << " was written";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::no_output);
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
    }
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(WholeFile, MakesFoldersAndReplaces) {
  const auto path = folder_ / "a" / "b" / "file.txt";
  write_whole_file(path, "first, and longer");
  write_whole_file(path, "second");
  EXPECT_EQ(text_of(path), "second");
  EXPECT_EQ(entries(path.parent_path()), 1U) << "a temporary file was left";
  EXPECT_EQ(fs::status(path).permissions() & fs::perms::owner_read, fs::perms::owner_read);
}

TEST_F(WholeFile, EmptyAndLargeComeBackByteForByte) {
  write_whole_file(folder_ / "empty", "");
  EXPECT_EQ(text_of(folder_ / "empty"), "");
  std::string large(3'000'001, '\0');
  for (std::size_t i = 0; i < large.size(); ++i) large[i] = static_cast<char>(i * 31);
  write_whole_file(folder_ / "large", large);
  EXPECT_EQ(text_of(folder_ / "large"), large);
}

TEST_F(WholeFile, LongestNameAllowedWorks) {
  const auto path = folder_ / std::string(255, 'n');
  write_whole_file(path, "x");
  EXPECT_EQ(text_of(path), "x");
}

TEST_F(WholeFile, KeepsALink) {
  write_whole_file(folder_ / "target", "old");
  fs::create_symlink("target", folder_ / "link");
  write_whole_file(folder_ / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(text_of(folder_ / "target"), "new");
}

TEST_F(WholeFile, SaysWhenTheDiskIsFull) {
  // /dev/full answers every write with ENOSPC; it must still be a device afterwards.
  expect_no_output("/dev/full", "No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(WholeFile, ShortWriteLeavesTheOldFileAndNoLitter) {
  // A size limit on files gives what a full disk gives: a write that stops in the middle.
  write_whole_file(folder_ / "kept", "old");
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, old_limit.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  expect_no_output(folder_ / "kept", "File too large");
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(text_of(folder_ / "kept"), "old");
  EXPECT_EQ(entries(folder_), 1U);
}

TEST_F(WholeFile, SaysWhenAFolderIsInTheWay) {
  fs::create_directories(folder_ / "name" / "inside");
  expect_no_output(folder_ / "name", "Is a directory");
  EXPECT_EQ(entries(folder_), 1U);
}

TEST_F(WholeFile, SaysWhenAFileIsWhereAFolderShouldBe) {
  write_whole_file(folder_ / "file", "x");
  expect_no_output(folder_ / "file" / "below", "Not a directory");
}

TEST_F(WholeFile, SaysWhenPermissionIsMissing) {
  // Root may write everywhere, so it becomes nobody for a moment.
  const uid_t user = geteuid();
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read |
                               fs::perms::others_exec);
  if (user == 0) {
    ASSERT_EQ(seteuid(65534), 0);
  }
  expect_no_output(folder_ / "file", "Permission denied");
  if (user == 0) {
    ASSERT_EQ(seteuid(0), 0);
  }
  fs::permissions(folder_, fs::perms::owner_all);
  EXPECT_EQ(entries(folder_), 0U);
}

TEST_F(WholeFile, ManyWritersAtOnceLeaveOneWholeFile) {
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t) {
    threads.emplace_back([this, t] {
      for (int i = 0; i < 20; ++i) write_whole_file(folder_ / "shared", std::string(10000, char('a' + t)));
    });
  }
  for (auto& thread : threads) thread.join();
  const std::string text = text_of(folder_ / "shared");
  ASSERT_EQ(text.size(), 10000U);
  EXPECT_EQ(text.find_first_not_of(text[0]), std::string::npos) << "two writers were mixed";
  EXPECT_EQ(entries(folder_), 1U);
}

TEST_F(WholeFile, ReadingSaysWhatIsWrong) {
  for (const auto& path : {folder_ / "missing", folder_}) {
    try {
      read_whole_file(path);
      FAIL() << path << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ExitCode::bad_input);
      EXPECT_NE(std::string(error.what()).find(path.string()), std::string::npos);
    }
  }
}

TEST_F(WholeFile, ReadsFilesWithoutASize) {
  EXPECT_FALSE(read_whole_file("/proc/self/status").empty());
}

}  // namespace
}  // namespace plisse
