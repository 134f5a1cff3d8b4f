// When does something happen?
#include "answerer.hpp"

#include <algorithm>

#include "kith/explain/words.hpp"

namespace kith::detail {

namespace {

constexpr std::size_t kMaxPairs = 3;

}  // namespace

void Answerer::when() {
  const auto& happening = *question_.happening;
  reply_.question = "When " + does(happening, question_.negated) + scene_.context() + "?";
  if (question_.world) return when_in(*question_.world);
  std::vector<World> worlds;
  std::size_t possible = 0, yes = 0, perhaps = 0;
  double most = 0.0;
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
    worlds.push_back(look_at(scene_.start_in(m)));
    const auto& world = worlds.back();
    possible += world.start ? 1U : 0U;
    yes += world.happens ? 1U : 0U;
    perhaps += world.chance ? 1U : 0U;
    if (world.chance) most = std::max(most, *world.chance);
  }
  if (possible == 0) static_cast<void>(scene_.needed_start(last_world()));
  const auto n = question_.negated ? possible - yes : yes;
  const auto how = question_.negated ? Happens::kNo : most > 0.0 ? Happens::kMaybe : Happens::kYes;
  reply_.text = first_upper(says_that(happening, how)) + " in " + worlds_text(n, possible) + from_the_start();
  if (most > 0.0 && !question_.negated) {
    const auto chance = chance_text({std::nullopt, true, std::nullopt, most}, perhaps > 1);
    reply_.text += perhaps == yes ? chance : ", in " + std::to_string(perhaps) + " of them only" + chance.substr(1);
  }
  reply_.text += ".";
  if (yes == 0 || yes == possible) {
    when_alike(worlds);
  } else {
    when_differing(worlds);
  }
}

void Answerer::when_in(MdpIndex number) {
  const auto& happening = *question_.happening;
  const auto world = look_at(scene_.needed_start(number));
  reply_.text = first_upper(says_that(happening, world.how())) + " there" + chance_text(world);
  if (world.happens && !world.chance && world.step) reply_.text += ", in step " + std::to_string(*world.step + 1);
  reply_.text += ".";
  show_world(world);
}

void Answerer::when_alike(const std::vector<World>& worlds) {
  for (std::size_t m = worlds.size(); m-- > 0;) {
    if (worlds[m].start) return show_world(worlds[m]);
  }
}

std::vector<Answerer::Pair> Answerer::neighbours(const std::vector<World>& worlds) const {
  const auto groups = domain_.optional_groups();
  std::map<std::vector<bool>, std::size_t> numbers;
  for (std::size_t m = 0; m < worlds.size(); ++m) numbers.emplace(domain_.present_things(MdpIndex{m}), m);
  std::vector<Pair> pairs;
  for (std::size_t m = 0; m < worlds.size(); ++m) {
    if (!worlds[m].happens) continue;
    const auto variant = domain_.present_things(MdpIndex{m});
    const auto present = static_cast<std::size_t>(std::count(variant.begin(), variant.end(), true));
    for (std::size_t g = 0; g < groups.size(); ++g) {
      auto other = variant;
      other[g] = !other[g];
      const auto found = numbers.find(other);
      if (found == numbers.end() || !worlds[found->second].start || worlds[found->second].happens) continue;
      pairs.push_back({1, groups[g].cells.size(), present, m, found->second});
    }
  }
  return pairs;
}

std::vector<Answerer::Pair> Answerer::all_pairs(const std::vector<World>& worlds) const {
  constexpr std::size_t kMostWorlds = 128;  // more have neighbours, or it takes too long
  const auto groups = domain_.optional_groups();
  std::vector<Pair> pairs;
  const auto n = std::min(worlds.size(), kMostWorlds);
  for (std::size_t yes = 0; yes < n; ++yes) {
    for (std::size_t no = 0; no < n; ++no) {
      if (!worlds[yes].happens || !worlds[no].start || worlds[no].happens) continue;
      const auto toggled = toggled_groups(domain_, MdpIndex{yes}, MdpIndex{no});
      std::size_t cells = 0;
      for (const auto g : toggled) cells += groups[g].cells.size();
      pairs.push_back({toggled.size(), cells, 0, yes, no});
    }
  }
  return pairs;
}

void Answerer::when_differing(const std::vector<World>& worlds) {
  auto pairs = neighbours(worlds);
  if (pairs.empty()) pairs = all_pairs(worlds);
  std::sort(pairs.begin(), pairs.end());
  constexpr std::size_t kMaxTried = 60;
  if (pairs.size() > kMaxTried) pairs.resize(kMaxTried);
  if (show_pairs(worlds, pairs, false) == 0) static_cast<void>(show_pairs(worlds, pairs, true));
}

std::size_t Answerer::show_pairs(const std::vector<World>& worlds, const std::vector<Pair>& pairs, bool with_detours) {
  std::vector<std::string> told;
  for (const auto& pair : pairs) {
    if (told.size() == kMaxPairs) break;
    const auto& [yes, no] = std::pair{worlds[pair.yes], worlds[pair.no]};
    const auto for_it = scene_.contrast_to(*yes.start, *question_.happening, false);
    const auto against_it = scene_.contrast_to(*no.start, *question_.happening, true);
    const bool has_detour = (for_it && is_detour(domain_, *for_it)) || (against_it && is_detour(domain_, *against_it));
    if (has_detour && !with_detours) continue;
    const auto why_yes = because(for_it, nothing_else(MdpIndex{pair.yes}, *question_.happening, false));
    const auto why_no = because(against_it, nothing_else(MdpIndex{pair.no}, *question_.happening, true));
    if (std::find(told.begin(), told.end(), why_yes + why_no) != told.end()) continue;
    told.push_back(why_yes + why_no);
    // What was asked about comes first.
    const auto& first = question_.negated ? no : yes;
    const auto& second = question_.negated ? yes : no;
    show_one_of_pair(first, question_.negated ? against_it : for_it, question_.negated ? why_no : why_yes, "");
    show_one_of_pair(second, question_.negated ? for_it : against_it, question_.negated ? why_yes : why_no,
                     difference(atlas_.id(*first.start).mdp, atlas_.id(*second.start).mdp));
  }
  return told.size();
}

void Answerer::show_one_of_pair(const World& world, const std::optional<Contrast>& contrast, const std::string& why,
                                const std::string& differs) {
  show(*world.start, scene_.name_of(atlas_.id(*world.start).mdp) + differs + it_does(world) + why, contrast,
       world.step);
}

std::string Answerer::difference(MdpIndex from, MdpIndex to) const {
  constexpr std::size_t kFew = 3;
  const auto toggled = toggled_groups(domain_, from, to);
  return toggled.empty() || toggled.size() > kFew ? "" : ", " + difference_in_words(domain_, to, toggled);
}

void Answerer::show_world(const World& world) {
  const auto& happening = *question_.happening;
  const auto contrast = scene_.contrast_to(*world.start, happening, !world.happens);
  const auto number = atlas_.id(*world.start).mdp;
  show(*world.start,
       scene_.name_of(number) + it_does(world) + because(contrast, nothing_else(number, happening, !world.happens)),
       contrast, world.step);
}

}  // namespace kith::detail
