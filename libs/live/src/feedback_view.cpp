#include <algorithm>

#include "exploration.hpp"
#include "kith/explain/board_json.hpp"
#include "kith/explain/contrast.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/words.hpp"
#include "kith/mdp/behaviour.hpp"
#include "live_texts.hpp"
#include "room_view.hpp"
#include "session_summary.hpp"

namespace kith {
namespace {

// A feature that one path has more of than the other.
struct Excess {
  std::size_t feature = 0;
  std::int64_t n = 0;
  bool more = false;  // the other path has some, too
};

std::string as_verbs(const Domain& domain, const std::vector<Excess>& all) {
  std::vector<std::string> words;
  for (const auto& one : all) words.push_back(doing(domain.wording(one.feature), one.n, one.more));
  return listed(words);
}

std::string as_nouns(const Domain& domain, const std::vector<Excess>& all) {
  std::vector<std::string> words;
  for (const auto& one : all) {
    const auto& wording = domain.wording(one.feature);
    words.push_back(one.more ? times_more(wording, one.n) : times(wording, one.n));
  }
  return listed(words);
}

// A path that is worse in every respect.
std::string detour_in_words(const Domain& domain, const std::vector<Excess>& costs, const std::vector<Excess>& lost) {
  std::string text;
  if (!costs.empty()) {
    const bool has_verbs = std::none_of(costs.begin(), costs.end(),
                                        [&](const Excess& one) { return domain.wording(one.feature).do_one.empty(); });
    const bool all_more = std::all_of(costs.begin(), costs.end(), [](const Excess& one) { return one.more; });
    text = has_verbs ? "Your path makes the robot " + as_verbs(domain, costs) + (all_more ? " than needed" : "")
                     : "Your path costs the robot " + as_nouns(domain, costs);
  }
  if (!lost.empty()) {
    text += (text.empty() ? "Your path leaves out " : ", and leaves out ") + as_nouns(domain, lost);
  }
  return text + '.';
}

// In which part of the cases a choice counts something of a feature.
double chance_of(const Mdp& mdp, const Choice& choice, std::size_t feature) {
  double chance = 0.0;
  for (const auto& outcome : mdp.outcomes(choice)) {
    if (mdp.features(outcome)[feature] != 0.0) chance += outcome.probability;
  }
  return chance;
}

// Costs that follow from the robot's action at a place less often than from another one.
std::vector<std::size_t> spared_by(const Domain& domain, MdpIndex world, StateIndex s, ActionIndex robot,
                                   ActionIndex own) {
  const auto& mdp = domain.mdp(world);
  const auto& choices = mdp.choices(s);
  const auto& robots = *std::ranges::find(choices, robot, &Choice::action);
  const auto& owns = *std::ranges::find(choices, own, &Choice::action);
  std::vector<std::size_t> spared;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    constexpr double kRounding = 1e-9;
    const bool is_rarer = chance_of(mdp, robots, k) + kRounding < chance_of(mdp, owns, k);
    if (domain.weights().integer[k] < 0 && is_rarer) spared.push_back(k);
  }
  return spared;
}

// What somebody can know who has seen all demonstrations, all feedback, and what they explored.
std::vector<HalfSpace> known_to(const RoomParts& room, const LiveSeat& seat) {
  auto known = taught_so_far(room.state);
  known.insert(known.end(), seat.explored.begin(), seat.explored.end());
  return known;
}

}  // namespace

std::string cost_in_words(const Domain& domain, MdpIndex world, const IntegerVector& robot_counts,
                          const IntegerVector& own_counts) {
  if (robot_counts == own_counts || sign_of_dot(domain.weights().integer, robot_counts - own_counts) <= 0) return {};
  if (!is_exact(domain.mdp(world))) {
    const auto difference = robot_counts - own_counts;
    const auto risk = risk_in_words(domain, world, difference);
    return sentence((risk.empty() ? "" : risk + ": ") + on_average_in_words(domain, difference));
  }
  const auto robot = whole_counts(domain, robot_counts);
  const auto mine = whole_counts(domain, own_counts);
  std::vector<Excess> costs, lost;  // what the participant's path has more of, and less of
  bool is_trade = false;
  for (std::size_t k = 0; k < domain.num_features(); ++k) {
    const auto n = mine[k] - robot[k];
    if (n == 0) continue;
    const bool is_cost = domain.weights().integer[k] < 0;
    const Excess excess{k, n > 0 ? n : -n, mine[k] != 0 && robot[k] != 0};
    if (n > 0 && is_cost) {
      costs.push_back(excess);
    } else if (n < 0 && !is_cost) {
      lost.push_back(excess);
    } else {
      is_trade = true;
    }
  }
  if (is_trade) return "The robot takes another path: " + choice_in_words(domain, robot, mine) + ".";
  return detour_in_words(domain, costs, lost);
}

namespace {

// How the answer to a test compares with the robot's.
view::Judged judged_view(const RoomParts& room, const Test& test, bool right, const std::optional<GivenPath>& given) {
  const auto& atlas = *room.study.atlas;
  const auto& domain = atlas.domain();
  const auto [world, start] = atlas.id(test.start);
  const auto& mdp = domain.mdp(world);
  view::Judged judged;
  judged.at<"board">() = live_board(room.study, test.start);
  judged.at<"right">() = right;
  // Of a right answer that the shortest path gives, too, nothing is said.
  if (!right || test.is_shortest_wrong) {
    for (const auto& text : all_in_words(domain, test.covered)) judged.at<"why">().push_back(sentence(text));
  }

  auto robot = expected_path(atlas, test.start);
  std::string between;  // of the paths that are drawn, where counts would not say it
  if (given) {
    auto mine = judged_path(atlas, test.start, given->actions, given->for_ever).path;
    if (mdp.is_deterministic() && !is_exact(mdp)) between = choice_between(domain, world, robot, mine);
    const auto at = first_difference(mine, robot);
    judged.at<"differs_at">() = at;
    if (at) {
      const bool is_fork = *at < mine.actions.size() && *at < robot.actions.size();
      if (!right && is_fork && !mdp.is_deterministic()) {
        judged.at<"chance">() = {world_key(room.study, world), world_state(room.study, world, start).value_or(0),
                                 spared_by(domain, world, robot.states[*at], robot.actions[*at], mine.actions[*at])};
      }
      // Both may go round in a cycle for a while before they part.
      mine = written_out(std::move(mine), *at + 1);
      robot = written_out(std::move(robot), *at + 1);
    }
    auto path = path_json(domain, world, mine);
    judged.at<"mine">() = path["frames"];
    judged.at<"mine_repeats_from">() = path.value("repeats_from", Json{});
  }
  auto path = path_json(domain, world, robot);
  judged.at<"robot">() = path["frames"];
  judged.at<"robot_repeats_from">() = path.value("repeats_from", Json{});
  judged.at<"robot_repeats_text">() = path.value("repeats_text", Json{});

  judged.at<"unfinished">() = given && !given->is_finished;
  if (!right && given && given->counts) {
    judged.at<"cost">() = between.empty()
                              ? cost_in_words(domain, world, atlas.feature_counts(test.start), *given->counts)
                              : "The robot takes another path: " + between + ".";
  }
  return judged;
}

}  // namespace

view::Feedback feedback_view(const RoomParts& room, const LiveSeat& seat) {
  const auto& past = room.state.session->history().back();
  const auto& verdicts = past.feedback.final_verdicts(*seat.member);
  view::Feedback feedback;
  for (std::size_t t = 0; t < past.lesson.tests.size(); ++t) {
    const bool right = t < verdicts.size() && verdicts[t].correct;
    const auto& given = t < seat.paths.size() ? seat.paths[t] : std::nullopt;
    feedback.at<"tests">().push_back(judged_view(room, past.lesson.tests[t], right, given));
  }

  const bool all_right = past.feedback.all_right_in_the_end(*seat.member);
  const bool learned = past.feedback.component_learned;
  bool others_unsure = false;  // somebody else answered otherwise: why the group goes on for those who were right
  const auto& all_correct = past.feedback.all_correct;
  for (std::size_t m = 0; m < all_correct.size(); ++m) {
    others_unsure = others_unsure || (m != *seat.member && !past.feedback.verdicts[m].empty() && !all_correct[m]);
  }
  feedback.at<"all_right">() = all_right;
  feedback.at<"learned">() = learned;
  feedback.at<"others_unsure">() = all_right && !learned && others_unsure;
  if (room.study.group().screens.brackets) {
    feedback.at<"brackets">() =
        known_brackets(*room.study.atlas, known_to(room, seat),
                       room.study.atlas->knowledge_components()[past.lesson.component].features);
  }
  return feedback;
}

view::Explore explore_view(const RoomParts& room, const LiveSeat& seat) {
  const auto* lesson = last_lesson(room.state);
  const bool has_test = lesson != nullptr && !lesson->tests.empty();
  const auto first = has_test ? lesson->tests.back().start : room.study.sandbox;
  const auto& atlas = *room.study.atlas;
  return {explored(atlas, first).shown, placeable_symbols(room.study), known_brackets(atlas, known_to(room, seat)),
          seat.exploration ? std::optional{*seat.exploration} : std::nullopt};
}

}  // namespace kith
