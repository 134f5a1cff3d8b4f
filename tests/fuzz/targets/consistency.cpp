// Which members of a team agree: all largest sets, by trying every set.

#include "kith/belief/consistency.hpp"
#include "../half_spaces.hpp"

using namespace kith;
using fuzzing::require;

namespace {

using Lists = std::vector<std::vector<HalfSpace>>;

// The members of a set, by the bits of `set`, if their half-spaces and the prior's leave an interior.
std::optional<std::vector<std::size_t>> agreeing(const Lists& lists, const Cone& prior, std::size_t set) {
  auto all = prior.minimal_set();
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    if ((set >> i & 1) == 0) continue;
    members.push_back(i);
    all.insert(all.end(), lists[i].begin(), lists[i].end());
  }
  return has_interior(all) ? std::optional{members} : std::nullopt;
}

std::vector<std::vector<std::size_t>> largest(const Lists& lists, const Cone& prior) {
  std::vector<std::vector<std::size_t>> best{{}};
  for (std::size_t set = 1; set < std::size_t{1} << lists.size(); ++set) {
    const auto members = agreeing(lists, prior, set);
    if (!members || members->size() < best.front().size()) continue;
    if (members->size() > best.front().size()) best.clear();
    best.push_back(*members);
  }
  std::sort(best.begin(), best.end());
  return best;
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.head_bytes = 1, .width = 3};

fuzzing::Outcome fuzzing::run(std::string_view input) {
  fuzzing::Bytes bytes{input};
  const auto limit = static_cast<std::int64_t>(1 + bytes.below(4));
  const auto prior = Cone::intersection(fuzzing::half_spaces(bytes, 3, limit));
  if (!prior) return Outcome::kRefused;
  Lists lists(bytes.below(5));
  for (auto& list : lists) list = fuzzing::half_spaces(bytes, 3, limit);
  const auto result = largest_consistent_subsets(lists, *prior);
  require(result.reduced_lists.size() == lists.size(), "a reduced list per member");
  for (std::size_t i = 0; i < lists.size(); ++i) {
    require(agreeing(result.reduced_lists, *prior, std::size_t{1} << i).has_value(), "members agree with themselves");
    const bool sound = agreeing(lists, *prior, std::size_t{1} << i).has_value();
    require(!sound || result.reduced_lists[i] == lists[i], "who agrees with themselves loses nothing");
  }
  require(result.subsets == largest(result.reduced_lists, *prior), "the largest sets are those found by trying all");
  return Outcome::kRead;
}
