// The fingerprint against xxHash's published vectors, and that no two ways of adding collide by construction.
#include "base/hash.h"

#include <gtest/gtest.h>

#include <set>

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/files.h"

namespace plisse {
namespace {

TEST(Hash, EmptyInputIsThePublishedVector) {
  // XXH3 128 bits, seed 0, length 0: xxHash's own sanity table.
  EXPECT_EQ(Hash().hex(), "99aa06d3014798d86001c324468d497f");
}

TEST(Hash, PiecesAddUpToTheWhole) {
  std::vector<std::uint8_t> bytes(1000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i * 7);
  Hash whole, pieces;
  whole.add_bytes(bytes);
  for (std::size_t i = 0; i < bytes.size(); i += 250) pieces.add_bytes({bytes.data() + i, 250});
  EXPECT_EQ(whole.hex(), pieces.hex());
}

TEST(Hash, BoundariesAndKindsMatter) {
  std::set<std::string> seen;
  seen.insert(Hash().add("ab").add("c").hex());
  seen.insert(Hash().add("a").add("bc").hex());
  seen.insert(Hash().add("abc").hex());
  seen.insert(Hash().add(1).hex());
  seen.insert(Hash().add(1.0).hex());
  seen.insert(Hash().add(true).add(0).hex());
  seen.insert(Hash().add("").hex());
  seen.insert(Hash().hex());
  EXPECT_EQ(seen.size(), 8U);
  EXPECT_EQ(Hash().add(1.5F).hex(), Hash().add(1.5).hex());
}

TEST(Hash, CopiesGoOnAlone) {
  Hash first;
  first.add("shared");
  Hash second = first;
  second.add(2);
  EXPECT_EQ(first.hex(), Hash().add("shared").hex());
  EXPECT_EQ(second.hex(), Hash().add("shared").add(2).hex());
}

TEST(Hash, FilesCountByContent) {
  const test::TemporaryFolder folder;
  write_whole_file(folder / "a", "same");
  write_whole_file(folder / "b", "same");
  write_whole_file(folder / "c", "else");
  EXPECT_EQ(Hash().add_file(folder / "a").hex(), Hash().add_file(folder / "b").hex());
  EXPECT_NE(Hash().add_file(folder / "a").hex(), Hash().add_file(folder / "c").hex());
  try {
    Hash().add_file(folder / "missing");
    FAIL() << "a missing file was hashed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code, ExitCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("missing"), std::string::npos);
  }
}

}  // namespace
}  // namespace plisse
