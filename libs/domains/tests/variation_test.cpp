#include "kith/domains/variation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kith/domains/domain_file.hpp"

namespace kith {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(WithOneMap, MakesAFamilyOfOneOutOfEveryWorldOfTheBuiltIns) {
  for (const auto& built_in : built_in_domains()) {
    if (!built_in.files.empty()) continue;  // a model, or a map that is not drawn in the file
    const auto domain = load_domain(std::string{built_in.name});
    for (const std::size_t m : {std::size_t{0}, domain.num_mdps() - 1}) {
      const auto rows = domain.map()->draw(MdpIndex{m}, std::nullopt);
      const auto text = with_one_map(built_in.text, "one-world", rows);
      ASSERT_TRUE(text.has_value()) << built_in.name << " " << m;
      const auto reading = parse_domain(*text, "one-world");
      ASSERT_TRUE(reading.domain.has_value());
      EXPECT_EQ(reading.domain->id(), "one-world");
      EXPECT_EQ(reading.domain->num_mdps(), 1u);
      EXPECT_EQ(reading.domain->map()->draw(MdpIndex{0}, std::nullopt), rows);
      EXPECT_EQ(reading.domain->weights().integer, domain.weights().integer);
      EXPECT_EQ(reading.domain->mdp(MdpIndex{0}).num_states(), domain.mdp(MdpIndex{m}).num_states());
    }
  }
}

constexpr const char* kText = R"(schema = "kith.domain/1"
id = 'tiny'  # id = "no"
[map]
# rows = ["not these"]
rows = ["S]rG",  # "optional = true"
        "...."]
[map.legend]
"." = "floor"
"]" = { optional = "a-b", terrain = "gate" }
"r" = { terrain = "rubble", optional = true }
"S" = { start = true }
"G" = { goal = true }
[[feature]]
name = "rubble"
when = "leave:rubble"
[[feature]]
name = "step"
when = "action"
[reward]
weights = { rubble = -2, step = -1 }
)";

TEST(WithOneMap, KeepsCommentsAndIsNotMisledByThemOrByStrings) {
  ASSERT_TRUE(parse_domain(kText, "tiny").domain.has_value());
  const auto text = with_one_map(kText, "new", {"S.]G", "rrr."});
  ASSERT_TRUE(text.has_value());
  EXPECT_THAT(*text, HasSubstr("id = \"new\"  # id = \"no\""));
  EXPECT_THAT(*text, HasSubstr("# rows = [\"not these\"]"));
  EXPECT_THAT(*text, HasSubstr("{ terrain = \"rubble\" }"));
  EXPECT_THAT(*text, HasSubstr("{ terrain = \"gate\" }"));
  EXPECT_THAT(*text, Not(HasSubstr("S]rG")));
}

TEST(WithOneMap, FindsKeysInQuotes) {
  std::string text = kText;
  for (const std::string key : {"id = ", "rows = [\"S", "optional = \"", "optional = true }"}) {
    const auto length = key.find(' ');
    text.replace(text.find(key), length, '"' + key.substr(0, length) + '"');
  }
  const auto changed = with_one_map(text, "new", {"S.]G", "rrr."});
  ASSERT_TRUE(changed.has_value());
  EXPECT_THAT(*changed, HasSubstr("{ terrain = \"rubble\" }"));
  EXPECT_THAT(*changed, HasSubstr("{ terrain = \"gate\" }"));
}

TEST(WithOneMap, IsNothingForMapsThatAreNotSound) {
  EXPECT_FALSE(with_one_map(kText, "new", {"..]G", "rrr."}).has_value()) << "no start";
  EXPECT_FALSE(with_one_map(kText, "new", {"S.xG", "rrr."}).has_value()) << "an unknown symbol";
  EXPECT_FALSE(with_one_map("id = \"a\"\n", "new", {"S.G"}).has_value()) << "no map";
}

}  // namespace
}  // namespace kith
