#include "kith/domains/domain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <stdexcept>

#include "domains_under_test.hpp"
#include "kith/mdp/planner.hpp"

namespace kith {
namespace {

// Sorted numbers of states of all MDPs, with how often each occurs.
std::map<std::size_t, int> state_counts(const Domain& domain) {
  std::map<std::size_t, int> counts;
  for (std::size_t m = 0; m < domain.num_mdps(); ++m) ++counts[domain.mdp(MdpIndex{m}).num_states()];
  return counts;
}

TEST(ColoredTiles, HasTheExpectedSize) {
  const Domain domain = sound_domain(kColoredTiles);
  EXPECT_EQ(domain.num_mdps(), 512u);
  EXPECT_EQ(state_counts(domain), (std::map<std::size_t, int>{{24, 512}}));
  EXPECT_EQ(domain.num_starts(), 12'288u);
  EXPECT_EQ(domain.weights().integer, (IntegerVector{-26, -21, -4}));
}

TEST(Skateboard, HasTheExpectedSize) {
  const Domain domain = sound_domain(kSkateboard);
  EXPECT_EQ(domain.num_mdps(), 8u);
  EXPECT_EQ(state_counts(domain), (std::map<std::size_t, int>{{23, 4}, {360, 1}, {456, 2}, {552, 1}}));
  EXPECT_EQ(domain.num_starts(), 1'916u);
  EXPECT_EQ(domain.weights().integer, (IntegerVector{-14, -41, -80}));
}

TEST(Skateboard, HasItsStatesWhereTheThingsAre) {
  const Domain domain = sound_domain(kSkateboard);
  // Bits: west path, east path, board.
  EXPECT_EQ(domain.mdp(MdpIndex{0b001}).num_states(), 552u);
  EXPECT_EQ(domain.mdp(MdpIndex{0b111}).num_states(), 360u);
  EXPECT_TRUE(domain.map()->items_in(MdpIndex{0b110}).empty());
  EXPECT_EQ(domain.map()->items_in(MdpIndex{0b001}), (std::vector<std::size_t>{0}));
  EXPECT_EQ(domain.describe_world(MdpIndex{0b101}), "path@{(1,4),(2,4),(3,4),(4,4)} board@{(1,1)}");
}

TEST(Domain, NamesItsStates) {
  const Domain domain = sound_domain(kSkateboard);
  const MdpIndex m{0b001};
  EXPECT_TRUE(domain.map().has_value());
  EXPECT_EQ(domain.state_name(m, StateIndex{0}), "robot at (4,1), board at (1,1)");
  GridState riding = domain.map()->state(m, StateIndex{0});
  riding.robot = riding.items[0];
  riding.carried[0] = true;
  EXPECT_EQ(domain.state_name(m, domain.map()->find_state(m, riding).value()), "robot at (1,1), carrying board");
  EXPECT_THROW((void)domain.state_name(m, StateIndex{domain.mdp(m).num_states() + 1000}), std::invalid_argument);
}

TEST(Domain, StartsAnywhereButAtTheEnd) {
  const Domain domain = sound_domain(kSkateboard);
  std::size_t sum = 0;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const auto& starts = domain.starts(m);
    ASSERT_EQ(starts.size(), domain.mdp(m).num_states());
    for (std::size_t i = 0; i < starts.size(); ++i) ASSERT_EQ(starts[i], StateIndex{i});
    sum += starts.size();
  }
  EXPECT_EQ(domain.num_starts(), sum);
  EXPECT_TRUE(domain.is_exact());
  EXPECT_EQ(domain.count_scale(), 1);
}

// A slow reading of the rules, one state at a time, in plain terms. Covers the
// domains of this file: moves, one item, one kind of station, and the boards'
// rule that a rider cannot enter a path.
std::optional<GridState> next_state(const Domain& domain, MdpIndex m, const GridState& s, const std::string& action) {
  static const std::map<std::string, Cell> kMoves{
      {"up", {0, 1}}, {"down", {0, -1}}, {"left", {-1, 0}}, {"right", {1, 0}}};
  GridState next = s;
  const bool carries = std::ranges::count(s.carried, true) > 0;
  if (action == "pickup") {
    if (carries || s.items.empty() || s.items[0] != s.robot) return std::nullopt;
    next.carried[0] = true;
  } else if (action == "dropoff") {
    if (!carries) return std::nullopt;
    next.carried[0] = false;
  } else {
    next.robot = {s.robot.x + kMoves.at(action).x, s.robot.y + kMoves.at(action).y};
    const bool off = next.robot.x < 1 || next.robot.y < 1 || next.robot.x > domain.map()->width() ||
                     next.robot.y > domain.map()->height();
    if (off || domain.map()->content(m, next.robot).wall) return std::nullopt;
    if (carries && domain.map()->content(m, next.robot).terrain == "path") return std::nullopt;
    if (carries) next.items[0] = next.robot;
    std::erase(next.stations, s.robot);
  }
  return next;
}

std::vector<double> features_of(const Domain& domain, MdpIndex m, const GridState& s, const GridState& next) {
  const std::string left = s.robot != next.robot ? domain.map()->content(m, s.robot).terrain : "";
  if (domain.id() == "skateboard") {
    const bool board = std::ranges::count(s.carried, true) > 0 || s.robot == next.robot;
    return {board ? 1.0 : 0.0, !board && left == "path" ? 1.0 : 0.0, !board && left != "path" ? 1.0 : 0.0};
  }
  if (domain.id() == "colored-tiles") return {left == "a" ? 1.0 : 0.0, left == "b" ? 1.0 : 0.0, 1.0};
  return {left == "rubble" ? 1.0 : 0.0, s.stations.size() > next.stations.size() ? 1.0 : 0.0, 1.0};
}

bool is_over(const Domain& domain, MdpIndex m, const GridState& s) {
  if (domain.map()->content(m, s.robot).goal) return true;
  return domain.id() == "item-delivery" && !s.carried[0] &&
         !domain.map()->content(m, s.items[0]).destination_of.empty();
}

// Laws of every domain, checked for all MDPs or a spread of them.
class DomainLaws : public ::testing::TestWithParam<std::string> {
 protected:
  Domain domain_ = GetParam() == "item-delivery" ? load_domain("item-delivery")
                   : GetParam() == "tiles"       ? sound_domain(kColoredTiles)
                                                 : sound_domain(kSkateboard);
  std::size_t stride_ = std::max<std::size_t>(1, domain_.num_mdps() / 37);
};

TEST_P(DomainLaws, TransitionsAreThoseOfTheRules) {
  for (std::size_t i = 0; i < domain_.num_mdps(); i += stride_) {
    const MdpIndex m{i};
    const Mdp& mdp = domain_.mdp(m);
    for (std::size_t j = 0; j < mdp.num_states(); ++j) {
      const GridState s = domain_.map()->state(m, StateIndex{j});
      std::size_t c = 0;
      for (std::size_t a = 0; a < domain_.action_names().size(); ++a) {
        const auto next = next_state(domain_, m, s, domain_.action_names()[a]);
        if (!next) continue;
        ASSERT_LT(c, mdp.choices(StateIndex{j}).size());
        const Choice& choice = mdp.choices(StateIndex{j})[c++];
        ASSERT_EQ(choice.action, ActionIndex{a});
        const Outcome& outcome = mdp.outcomes(choice).front();
        ASSERT_EQ(domain_.map()->state(m, outcome.next), *next);
        const auto phi = mdp.features(outcome);
        ASSERT_EQ((std::vector<double>{phi.begin(), phi.end()}), features_of(domain_, m, s, *next));
        ASSERT_EQ(mdp.is_terminal(outcome.next), is_over(domain_, m, *next));
      }
      ASSERT_EQ(c, mdp.choices(StateIndex{j}).size());
    }
  }
}

TEST_P(DomainLaws, EveryStateIsFoundByWhatItLooksLike) {
  for (std::size_t i = 0; i < domain_.num_mdps(); i += stride_) {
    const MdpIndex m{i};
    const Mdp& mdp = domain_.mdp(m);
    for (std::size_t s = 0; s < mdp.num_states() + mdp.num_terminals(); ++s) {
      ASSERT_EQ(domain_.map()->find_state(m, domain_.map()->state(m, StateIndex{s})), StateIndex{s});
    }
  }
}

TEST_P(DomainLaws, FeaturesAreThereIfSomeTransitionHasThem) {
  for (std::size_t i = 0; i < domain_.num_mdps(); ++i) {
    const Mdp& mdp = domain_.mdp(MdpIndex{i});
    std::vector<bool> seen(domain_.num_features(), false);
    for (std::size_t s = 0; s < mdp.num_states(); ++s) {
      for (const Choice& choice : mdp.choices(StateIndex{s})) {
        const auto phi = mdp.features(mdp.outcomes(choice).front());
        for (std::size_t k = 0; k < phi.size(); ++k) seen[k] = seen[k] || phi[k] != 0.0;
      }
    }
    for (std::size_t k = 0; k < seen.size(); ++k) ASSERT_EQ(mdp.has_feature(k), seen[k]);
  }
}

TEST_P(DomainLaws, VariantsCountUpWithTheLastBitFastest) {
  for (std::size_t i = 0; i < domain_.num_mdps(); ++i) {
    std::size_t index = 0;
    for (const bool bit : domain_.present_things(MdpIndex{i})) index = 2 * index + (bit ? 1 : 0);
    ASSERT_EQ(index, i);
  }
}

// The documented formula over digits that the test collects itself.
TEST_P(DomainLaws, DissimilarityIsTheDocumentedSum) {
  const auto digits = [&](StartId start) {
    const GridState s = domain_.map()->state(start.mdp, start.start);
    std::vector<int> list{s.robot.x, s.robot.y};
    for (std::size_t i = 0; i < s.items.size(); ++i) {
      list.insert(list.end(), {s.items[i].x, s.items[i].y, s.carried[i] ? 1 : 0});
    }
    for (const Cell& cell : s.stations) list.insert(list.end(), {cell.x, cell.y});
    return list;
  };
  const auto toggled = [&](MdpIndex m) {
    auto bits = domain_.present_things(m);
    if (domain_.id() == "item-delivery") bits.pop_back();  // the charger
    return bits;
  };
  for (std::size_t i = 0; i < 400; ++i) {
    const MdpIndex ma{i * 7919 % domain_.num_mdps()};
    const MdpIndex mb{i * 104'729 % domain_.num_mdps()};
    const StartId a{ma, StateIndex{i * 31 % domain_.mdp(ma).num_states()}};
    const StartId b{mb, StateIndex{i * 57 % domain_.mdp(mb).num_states()}};
    const auto da = digits(a);
    const auto db = digits(b);
    int expected = 0;
    for (std::size_t k = 0; k < std::min(da.size(), db.size()); ++k) expected += 2 * std::abs(da[k] - db[k]);
    for (std::size_t k = 0; k < toggled(ma).size(); ++k) expected += toggled(ma)[k] != toggled(mb)[k] ? 1 : 0;
    const auto stations = [&](StartId d) {
      return static_cast<int>(domain_.map()->state(d.mdp, d.start).stations.size());
    };
    expected += std::abs(stations(a) - stations(b));
    ASSERT_EQ(domain_.dissimilarity(a, b), expected);
    ASSERT_EQ(domain_.dissimilarity(b, a), expected);
    ASSERT_EQ(domain_.dissimilarity(a, a), 0);
  }
}

TEST_P(DomainLaws, PicturesAreOfStartsThatExist) {
  const StartId good{MdpIndex{0}, StateIndex{0}};
  const StartId no_world{MdpIndex{domain_.num_mdps()}, StateIndex{0}};
  const StartId no_start{MdpIndex{0}, StateIndex{domain_.mdp(MdpIndex{0}).num_states()}};
  for (const StartId bad : {no_world, no_start}) {
    EXPECT_THROW((void)domain_.complexity(bad), std::invalid_argument);
    EXPECT_THROW((void)domain_.dissimilarity(bad, good), std::invalid_argument);
    EXPECT_THROW((void)domain_.dissimilarity(good, bad), std::invalid_argument);
  }
}

TEST_P(DomainLaws, CopiesAreTheSameDomain) {
  const Domain copy = domain_;
  EXPECT_EQ(copy.num_starts(), domain_.num_starts());
  EXPECT_EQ(copy.map()->state(MdpIndex{1}, StateIndex{2}), domain_.map()->state(MdpIndex{1}, StateIndex{2}));
  EXPECT_EQ(copy.initial_state(MdpIndex{0}), StateIndex{0});
}

TEST_P(DomainLaws, BadIndicesAreRefused) {
  const MdpIndex beyond{domain_.num_mdps()};
  EXPECT_THROW((void)domain_.mdp(beyond), std::invalid_argument);
  EXPECT_THROW((void)domain_.map()->state(MdpIndex{0}, StateIndex{1'000'000}), std::invalid_argument);
  EXPECT_THROW((void)domain_.complexity({beyond, StateIndex{0}}), std::invalid_argument);
  EXPECT_THROW((void)domain_.map()->content(MdpIndex{0}, Cell{0, 1}), std::invalid_argument);
  EXPECT_THROW((void)domain_.weights().return_of(IntegerVector{1, 2}), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(All, DomainLaws, ::testing::Values("item-delivery", "tiles", "skateboard"),
                         [](const auto& c) { return c.param == "item-delivery" ? "item_delivery" : c.param; });

TEST(Complexity, CountsOptionalThingsAndStationsThatAreLeft) {
  const Domain delivery = load_domain("item-delivery");
  EXPECT_EQ(delivery.complexity({MdpIndex{0}, StateIndex{0}}), 0);
  EXPECT_EQ(delivery.complexity({MdpIndex{63}, StateIndex{0}}), 6);
  GridState used = delivery.map()->state(MdpIndex{63}, StateIndex{0});
  used.stations.clear();
  used.robot = {3, 3};
  EXPECT_EQ(delivery.complexity({MdpIndex{63}, *delivery.map()->find_state(MdpIndex{63}, used)}), 5);
  EXPECT_EQ(sound_domain(kColoredTiles).complexity({MdpIndex{0b111000011}, StateIndex{3}}), 5);
  EXPECT_EQ(sound_domain(kSkateboard).complexity({MdpIndex{0b101}, StateIndex{0}}), 5);
}

TEST(FindState, RefusesWhatIsNoState) {
  const Domain domain = load_domain("item-delivery");
  const GridState good = domain.map()->state(MdpIndex{1}, StateIndex{0});
  const auto refused = [&](auto&& change) {
    GridState s = good;
    change(s);
    return !domain.map()->find_state(MdpIndex{1}, s).has_value();
  };
  EXPECT_FALSE(refused([](GridState&) {}));
  EXPECT_TRUE(refused([](GridState& s) { s.robot = {1, 3}; }));  // a wall
  EXPECT_TRUE(refused([](GridState& s) { s.robot = {9, 9}; }));  // off the map
  EXPECT_TRUE(refused([](GridState& s) { s.items.clear(); }));   // an item is missing
  EXPECT_TRUE(refused([](GridState& s) { s.items[0] = {0, 0}; }));
  EXPECT_TRUE(refused([](GridState& s) { s.stations.push_back({1, 1}); }));  // no station there
  EXPECT_TRUE(refused([](GridState& s) { s.exited = true; }));
  EXPECT_TRUE(refused([](GridState& s) { s.carried[0] = true, s.items[0] = {2, 2}; }));
  EXPECT_FALSE(domain.map()->find_state(MdpIndex{0}, good).has_value());  // that MDP has no charger
}

TEST(Draw, ShowsTheMapOfTheVariant) {
  const Domain domain = load_domain("item-delivery");
  using Rows = std::vector<std::string>;
  EXPECT_EQ(domain.map()->draw(MdpIndex{63}, std::nullopt), (Rows{"#.rB", "#rrr", "G.rS"}));
  EXPECT_EQ(domain.map()->draw(MdpIndex{0}, std::nullopt), (Rows{"#...", "#...", "G..S"}));
  EXPECT_EQ(domain.map()->draw(MdpIndex{63}, StateIndex{0}), (Rows{"#.rB", "#rrr", "G.r@"}));
}

TEST(Draw, ShowsThingsWhereTheyAre) {
  const Domain domain = load_domain("item-delivery");
  GridState s{{3, 2}, {{2, 3}}, {false}, {}, false};
  EXPECT_EQ(domain.map()->draw(MdpIndex{1}, domain.map()->find_state(MdpIndex{1}, s)),
            (std::vector<std::string>{"#*..", "#.@.", "G..."}));
}

TEST(ReturnOf, TakesTheWeightsAtLengthOne) {
  const Domain domain = load_domain("item-delivery");
  // (-3, 3.5, -1) . (1, 1, 5) / sqrt(9 + 12.25 + 1)
  EXPECT_NEAR(domain.weights().return_of(IntegerVector{1, 1, 5}), -4.5 / 4.716990566028302, 1e-12);
  std::string text = kColoredTiles;
  text.replace(text.find("[reward]"), 8, "[reward]\nnormalize = \"l1\"");
  EXPECT_NEAR(sound_domain(text).weights().return_of(IntegerVector{1, 0, 4}), -10.5 / 12.75, 1e-12);
}

}  // namespace
}  // namespace kith
