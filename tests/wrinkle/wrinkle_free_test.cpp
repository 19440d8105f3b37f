// Which faces have no wrinkles, by both rules, on strips whose answers are counted by hand.
#include "wrinkle/wrinkle_free.h"

#include <gtest/gtest.h>

#include "wrinkle/meshes.h"

namespace plisse::wrinkle {
namespace {

// A strip of triangles one beside the other, with this smaller eigenvalue of the strain in each.
std::vector<bool> wrinkle_free(const std::vector<double>& compression, WrinkleFreeRule rule) {
  std::vector<shell::Face> faces;
  for (std::uint32_t i = 0; i < compression.size(); ++i)
    faces.push_back(i % 2 == 0 ? shell::Face{i, i + 1, i + 2} : shell::Face{i + 1, i, i + 2});
  std::vector<FaceForms> forms(compression.size());
  for (std::size_t f = 0; f < forms.size(); ++f) forms[f].strain.diagonal() << 10, compression[f];  // λ₁, λ₂
  return wrinkle_free_faces(forms, shell::build_topology(faces, compression.size() + 2), rule);
}
using Flags = std::vector<bool>;

// The paper's rule: a face's λ₂ averaged with its neighbours'.
TEST(WrinkleFree, ThePapersRuleTakesMeans) {
  EXPECT_EQ(wrinkle_free({-1, -1, -1, -1}, WrinkleFreeRule::paper), Flags({false, false, false, false}));
  EXPECT_EQ(wrinkle_free({3, 3, 3, 3}, WrinkleFreeRule::paper), Flags({true, true, true, true}));
  // Sums of a face and its neighbours: −13, −14, 1, 11, 12. The third is compressed itself.
  EXPECT_EQ(wrinkle_free({-9, -4, -1, 6, 6}, WrinkleFreeRule::paper),
            Flags({false, false, true, true, true}));
  EXPECT_EQ(wrinkle_free({0, 0, 0}, WrinkleFreeRule::paper), Flags({false, false, false}))
      << "what is not stretched may wrinkle";
}

TEST(WrinkleFree, LoneFacesJoinWhatIsRoundThem) {
  // Sums: 10, 7, −1, 7, 10, and the same with other signs: the third face stands alone.
  EXPECT_EQ(wrinkle_free({9, 1, -3, 1, 9}, WrinkleFreeRule::paper), Flags({true, true, true, true, true}));
  EXPECT_EQ(wrinkle_free({-9, -1, 3, -1, -9}, WrinkleFreeRule::paper),
            Flags({false, false, false, false, false}));
}

// The authors' program: λ₂ ≥ 0 of each face by itself, and what lies between such faces' corners.
TEST(WrinkleFree, TheAuthorsRuleLooksAtFacesAndTheirCorners) {
  EXPECT_EQ(wrinkle_free({-1, -1, -1, 0}, WrinkleFreeRule::authors), Flags({false, false, false, true}))
      << "λ₂ = 0 is no compression";
  // Faces 0 and 3 have the corners 0, 1, 2 and 3, 4, 5: those of the faces 1 and 2 as well.
  EXPECT_EQ(wrinkle_free({1, -1, -1, 1}, WrinkleFreeRule::authors), Flags({true, true, true, true}));
  EXPECT_EQ(wrinkle_free({1, -1, -1, -1}, WrinkleFreeRule::authors), Flags({true, false, false, false}));
}

}  // namespace
}  // namespace plisse::wrinkle
