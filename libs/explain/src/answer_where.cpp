// Where does something happen?
#include "answerer.hpp"

#include <algorithm>

#include "kith/core/text.hpp"

namespace kith::detail {

namespace {

constexpr std::size_t kMaxCells = 4;

}  // namespace

Answerer::Spot Answerer::spot_of(MdpIndex world, StateIndex s) const {
  if (map_) return {map_->state(world, s).robot, ""};
  return {std::nullopt, domain_.state_name(world, s)};
}

void Answerer::add_places(MdpIndex world, std::map<Spot, Place>& places) const {
  const auto start = scene_.start_in(world);
  if (!start) return;
  const auto start_index = *start;
  const auto path = atlas_.trajectory(start_index);
  std::map<Spot, std::optional<std::size_t>> seen;  // and at which step it happens
  std::map<Spot, std::size_t> first_visit;
  for (std::size_t t = 0; t < path.actions.size(); ++t) {
    const auto spot = spot_of(world, path.states[t]);
    first_visit.emplace(spot, t);
    auto& step = seen[spot];
    if (!step && scene_.is_at(world, path.states[t], path.actions[t], *question_.happening)) step = t;
  }
  for (const auto& [spot, step] : seen) {
    auto& place = places[spot];
    ++place.visited;
    if (step.has_value() == question_.negated) continue;
    if (place.worlds++ > 0) continue;
    place.start = start_index;
    place.step = step.value_or(first_visit.at(spot));
    place.text = scene_.spot_text(world, path.states[place.step]);
  }
}

void Answerer::where() {
  const auto& happening = *question_.happening;
  reply_.question = "Where " + does(happening, question_.negated) + scene_.context() + "?";
  if (question_.world) static_cast<void>(scene_.needed_start(*question_.world));
  std::map<Spot, Place> places;
  const auto first = question_.world ? question_.world->value() : 0;
  const auto end = question_.world ? first + 1 : domain_.num_mdps();
  for (MdpIndex m{first}; m.value() < end; ++m) add_places(m, places);
  std::erase_if(places, [](const auto& entry) { return entry.second.worlds == 0; });
  if (places.empty()) {
    reply_.text = first_upper(says_that(happening, Happens::kYes)) + (question_.negated ? " everywhere" : " nowhere") +
                  scene_.condition() + " " + on_the_way() + ".";
    return show_world(look_at(scene_.needed_start(question_.world.value_or(last_world()))));
  }
  std::vector<Place> sorted;
  sorted.reserve(places.size());
  for (const auto& [spot, place] : places) sorted.push_back(place);
  std::stable_sort(sorted.begin(), sorted.end(), [](const Place& a, const Place& b) { return a.worlds > b.worlds; });
  const auto how = question_.negated ? Happens::kNo : domain_.is_exact() ? Happens::kYes : Happens::kMaybe;
  reply_.text = first_upper(says_that(happening, how)) + " " + listed(place_texts(sorted)) + "," + scene_.condition() +
                " " + on_the_way() + ".";
  for (std::size_t i = 0; i < std::min(sorted.size(), kMaxCells); ++i) {
    const auto& place = sorted[i];
    show(place.start,
         scene_.name_of(atlas_.id(place.start).mdp) + ", " + place.text + ", step " + std::to_string(place.step + 1),
         std::nullopt, place.step);
  }
}

std::vector<std::string> Answerer::place_texts(const std::vector<Place>& places) const {
  constexpr std::size_t kMost = 12;
  std::vector<std::string> texts;
  std::size_t worlds = 0;
  for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) worlds += scene_.start_in(m) ? 1U : 0U;
  for (const auto& place : places) {
    if (texts.size() == kMost) break;
    const auto of = question_.negated ? place.visited : worlds;
    texts.push_back((texts.empty() || !map_ ? place.text : place.text.substr(3)) +
                    (question_.world ? "" : " in " + worlds_text(place.worlds, of)));
  }
  if (question_.negated && !question_.world) texts.front() += " that lead there";
  if (places.size() > kMost) texts.push_back(counted(places.size() - kMost, "other place"));
  return texts;
}

}  // namespace kith::detail
