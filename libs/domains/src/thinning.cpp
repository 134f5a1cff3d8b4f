#include "kith/domains/thinning.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <unordered_set>

#include "kith/core/distributions.hpp"

namespace kith::detail {
namespace {

constexpr std::int64_t kMostWorlds = 65'536;
constexpr std::int64_t kMostStarts = 1'000'000;
constexpr int kMostTries = 32;  // to draw a world that does not exist yet

// The groups of each kind of optional thing, as a mask; kinds in the order of their first group.
std::vector<std::uint64_t> masks_of_kinds(const FamilyMap& family_map) {
  std::vector<std::string> names;
  std::vector<std::uint64_t> masks;
  for (std::size_t group = 0; group < family_map.groups.size(); ++group) {
    const std::string name = symbol_name(family_map.symbols[family_map.groups[group].things.front().symbol]);
    const auto at = static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
    if (at == names.size()) {
      names.push_back(name);
      masks.push_back(0);
    }
    masks[at] |= family_map.bit_of(group);
  }
  return masks;
}

// Few things on in some worlds, many in others: the share that is on is drawn first.
std::uint64_t random_subset(std::size_t num_groups, RandomStream random) {
  const double share = uniform01(random);
  std::uint64_t mask = 0;
  for (std::size_t group = 0; group < num_groups; ++group) mask = mask << 1U | (uniform01(random) < share ? 1U : 0U);
  return mask;
}

// Steps to the nearest chosen state.
class Distances {
 public:
  explicit Distances(const Mdp& mdp) : mdp_{mdp}, steps_(mdp.num_states(), std::numeric_limits<std::uint32_t>::max()) {}

  void choose(std::size_t s) {
    steps_[s] = 0;
    queue_.assign(1, s);
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      const std::size_t at = queue_[i];
      for (const Arrival& arrival : mdp_.arrivals(StateIndex{at})) reach(arrival.from.value(), steps_[at] + 1);
      for (const Choice& choice : mdp_.choices(StateIndex{at})) {
        for (const Outcome& outcome : mdp_.outcomes(choice)) {
          if (!mdp_.is_terminal(outcome.next)) reach(outcome.next.value(), steps_[at] + 1);
        }
      }
    }
  }

  [[nodiscard]] std::size_t farthest() const {
    return static_cast<std::size_t>(std::ranges::max_element(steps_) - steps_.begin());
  }

 private:
  void reach(std::size_t s, std::uint32_t steps) {
    if (steps_[s] <= steps) return;
    steps_[s] = steps;
    queue_.push_back(s);
  }

  const Mdp& mdp_;
  std::vector<std::uint32_t> steps_;
  std::vector<std::size_t> queue_;
};

}  // namespace

Thinning read_thinning(TomlReader& file) {
  Thinning thinning;
  auto family = file.table("family", Presence::kOptional);
  if (!family) return thinning;
  if (const auto n = family->integer("worlds", Presence::kOptional, {1, kMostWorlds})) {
    thinning.worlds = static_cast<std::size_t>(*n);
  }
  if (const TomlValue* worlds = family->content().find("worlds")) thinning.worlds_place = worlds->place();
  const auto seed = family->integer("seed", Presence::kOptional, {0, std::numeric_limits<std::int64_t>::max()});
  thinning.seed = static_cast<std::uint64_t>(seed.value_or(1));
  if (const TomlValue* value = family->content().find("seed");
      value != nullptr && family->content().find("worlds") == nullptr) {
    file.report().error("E0226", value->place(), "'seed' draws worlds, but 'worlds' does not say how many",
                        "write worlds = NUMBER, or leave out the seed to build all of them");
  }

  if (const auto n = family->integer("starts", Presence::kOptional, {1, kMostStarts})) {
    thinning.starts = static_cast<std::size_t>(*n);
  }
  if (const TomlArray* listed = family->array("world", Presence::kOptional)) {
    thinning.listed = listed;
    thinning.listed_place = family->content().find("world")->place();
    for (const char* key : {"worlds", "seed"}) {
      const TomlValue* value = family->content().find(key);
      if (value == nullptr) continue;
      file.report().error("E0271", value->place(),
                          std::string{"'"} + key + "' draws worlds, but [[family.world]] lists them",
                          "remove one of them");
    }
  }
  family->finish();
  return thinning;
}

namespace {

// "NAME" or "NAME(3,2)": the groups of that name, or of things of that name; or the one with that cell.
std::optional<std::uint64_t> groups_called(const FamilyMap& family_map, const std::string& text) {
  const std::size_t open = text.find('(');
  const std::string name = text.substr(0, open);
  const std::string cell = open == std::string::npos ? "" : text.substr(open);
  std::uint64_t mask = 0;
  for (std::size_t group = 0; group < family_map.groups.size(); ++group) {
    const auto fits = [&](const MapThing& thing) {
      const bool named =
          family_map.groups[group].name == name || is_called(family_map.symbols[thing.symbol].content, name);
      return named && (cell.empty() || cell_text(family_map, thing.cell) == cell);
    };
    if (std::ranges::any_of(family_map.groups[group].things, fits)) mask |= family_map.bit_of(group);
  }
  return mask == 0 ? std::nullopt : std::optional{mask};
}

std::vector<std::string> names_of_groups(const FamilyMap& family_map) {
  std::vector<std::string> names;
  for (const CellGroup& group : family_map.groups) {
    std::string name = group.name;
    if (name.empty()) name = symbol_name(family_map.symbols[group.things.front().symbol]);
    if (std::ranges::find(names, name) == names.end()) names.push_back(std::move(name));
  }
  return names;
}

}  // namespace

void list_worlds(FamilyMap& family_map, TomlReport& report) {
  if (family_map.thinning.listed == nullptr) return;
  const TomlArray& list = *family_map.thinning.listed;
  if (list.empty() || list.size() > static_cast<std::size_t>(kMostWorlds)) {
    report.error("E0271", family_map.thinning.listed_place, "a family has 1 to 65536 worlds",
                 "list each as [[family.world]] with present = [...]");
    return;
  }

  std::map<std::uint64_t, std::size_t> line_of;
  for (const TomlValue& value : list) {
    if (read_table(value, "a world", report) == nullptr) continue;
    TomlReader reader{*value.table(), value.place(), "[[family.world]]", report};
    family_map.world_names.push_back(reader.string("name", Presence::kOptional).value_or(""));
    std::uint64_t mask = 0;
    if (const TomlArray* present = reader.array("present", Presence::kRequired)) {
      for (const TomlValue& element : *present) {
        const auto name = read_string(element, "every element of 'present'", report);
        if (!name) continue;
        const auto groups = groups_called(family_map, *name);
        mask |= groups.value_or(0);
        if (groups) continue;
        report.error("E0271", element.place(), "nothing optional is called '" + *name + "'",
                     family_map.groups.empty() ? "mark something on the map or a layer as optional"
                                               : suggestion(*name, names_of_groups(family_map)));
      }
      const auto [at, is_new] = line_of.try_emplace(mask, value.place().line);
      if (!is_new) {
        report.error("E0271", value.place(),
                     "this world has the same things as the one at line " + std::to_string(at->second),
                     "remove one of them");
      }
    }
    reader.finish();
    family_map.masks.push_back(mask);
  }
}

std::vector<std::uint64_t> choose_masks(const FamilyMap& family_map, std::size_t num_worlds, std::uint64_t seed) {
  const std::size_t num_groups = family_map.groups.size();
  const std::uint64_t all = num_groups == 0 ? 0 : std::numeric_limits<std::uint64_t>::max() >> (64 - num_groups);
  std::vector<std::uint64_t> masks;
  std::unordered_set<std::uint64_t> taken;
  const auto add = [&](std::uint64_t mask) {
    if (masks.size() < num_worlds && taken.insert(mask).second) masks.push_back(mask);
  };
  add(0);
  add(all);
  const auto kinds = masks_of_kinds(family_map);
  for (const std::uint64_t kind : kinds) add(kind);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    for (std::size_t j = i + 1; j < kinds.size(); ++j) add(kinds[i] | kinds[j]);
  }
  const RandomStream draws{seed};
  std::uint64_t n = 0;
  while (masks.size() < num_worlds) {
    std::uint64_t mask = random_subset(num_groups, draws.split(n++));
    for (int tries = 1; tries < kMostTries && taken.contains(mask); ++tries) {
      mask = random_subset(num_groups, draws.split(n++));
    }
    while (taken.contains(mask)) mask = (mask + 1) & all;
    add(mask);
  }

  // As in a whole family, the last world has everything.
  if (masks.size() > 1) std::rotate(masks.begin() + 1, masks.begin() + 2, masks.end());
  return masks;
}

std::vector<StateIndex> spread_states(const Mdp& mdp, std::size_t most) {
  std::vector<StateIndex> chosen;
  if (most >= mdp.num_states()) {
    for (std::size_t s = 0; s < mdp.num_states(); ++s) chosen.emplace_back(s);
    return chosen;
  }
  Distances distances{mdp};
  for (std::size_t s = 0; chosen.size() < most; s = distances.farthest()) {
    distances.choose(s);
    chosen.emplace_back(s);
  }
  std::ranges::sort(chosen);
  return chosen;
}

}  // namespace kith::detail
