#include <gtest/gtest.h>

#include <set>
#include <string>

#include "atlases.hpp"
#include "error_ids.hpp"
#include "kith/core/error.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/question.hpp"
#include "kith/explain/target.hpp"

namespace kith {
namespace {

// The id of what is thrown.
template <typename Call>
std::string id_of(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.diagnostics().at(0).id;
  }
  return "nothing";
}

TEST(ExplainErrorIds, AreAllTriggered) {
  const auto& atlas = testing::atlas_of("item-delivery");
  std::set<std::string> triggered;
  for (const auto* question : {"", "when rechrge", "why up at (9,9)", "when up in world 99", "when",
                               "why down at (4,3)", "what if no parcel"}) {
    triggered.insert(id_of([&] { static_cast<void>(answer_question(atlas, question)); }));
  }
  for (const auto* constraint : {"(1,2)", "(1,0,0)"}) {
    triggered.insert(id_of([&] { static_cast<void>(parse_constraint(atlas, constraint)); }));
  }
  auto road = parse_domain(testing::kOneRoad, "road.toml");
  const Atlas one_road{*std::move(road.domain)};
  triggered.insert(id_of([&] { require_something_to_teach(one_road); }));
  auto known = testing::error_ids_in("explain");
  EXPECT_GE(known.size(), 10u) << "an empty scan checks nothing";
  for (const auto* elsewhere : {"E1111", "E1112"}) known.erase(elsewhere);  // by the tests of kith find
  EXPECT_EQ(triggered, known);
}

}  // namespace
}  // namespace kith
