#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "input.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/transcript.hpp"
#include "kith/study/transcript_json.hpp"

namespace kith::cli {
namespace {

struct TeachOptions {
  std::string domain;
  std::string group;
  std::string strategy = "common";
  std::uint64_t seed = 1;
  std::string study = "paper";  ///< Where learner types and the teacher's settings come from.
  std::vector<std::string> set;
  std::string from;  ///< A run folder ...
  std::string team;  ///< ... and the number of one of its teams, as typed: only the folder tells how many there are.
  std::optional<std::size_t> forecast;  ///< Imagined sessions; none: as the study says.
};

// One team, and everything needed to teach it.
struct Assignment {
  Domain domain;
  StudySpec spec;
  TeamAddress address;
};

Assignment from_run_folder(const TeachOptions& options) {
  auto reading = read_run_folder(options.from);
  if (!reading.study) throw Error{reading.diagnostics};
  const auto addresses = team_addresses(*reading.study);
  const auto wrong = wrong_integer(options.team, {1, static_cast<std::int64_t>(addresses.size())});
  if (!wrong.empty()) refuse("--team " + wrong);
  const auto& address = addresses[std::stoul(options.team) - 1];
  return {*std::move(reading.domain), reading.study->variants[address.variant], address};
}

Assignment from_options(const TeachOptions& options) {
  if (options.domain.empty()) refuse("kith teach needs a DOMAIN, or --from DIR --team N");
  if (options.group.empty()) refuse("kith teach needs --group, the members' learner types, such as NNP");
  auto reading = study_of(options.study, options.set);
  auto spec = reading.study->variants.front();
  std::string letters;
  for (const auto& type : spec.learner_types) letters += type.letter;
  if (const auto at = options.group.find_first_not_of(letters); at != std::string::npos) {
    std::string capitals;
    for (const char letter : options.group)
      capitals += static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
    refuse(fmt::format(
        "study '{}' has no learner type '{}', only {}{}", options.study, options.group[at], fmt::join(letters, ", "),
        capitals.find_first_not_of(letters) == std::string::npos ? fmt::format("; did you mean --group {}?", capitals)
                                                                 : ""));
  }
  constexpr std::size_t kMaxTeamSize = 30;
  if (options.group.size() > kMaxTeamSize) refuse("a group has at most 30 members");
  const auto is_there = std::any_of(spec.strategies.begin(), spec.strategies.end(),
                                    [&](const auto& one) { return one.name == options.strategy; });
  if (!is_there) spec.strategies.push_back(strategy_named(options.strategy));
  spec.domain = options.domain;
  spec.seed = options.seed;
  spec.factors.clear();
  auto domain = load_domain(options.domain);
  take_domain(spec, domain);
  return {std::move(domain), spec, {0, options.strategy, options.group, 1, 1}};
}

void declare(OptionList& list, TeachOptions& options) {
  std::vector<std::string> names;
  for (const auto& kind : strategy_kinds()) names.emplace_back(kind.name);
  const std::vector others{
      list.domain(options.domain),
      list.text("--group", options.group, "LETTERS", "The members' learner types, one letter each"),
      list.word("--strategy", options.strategy, "NAME", names, "Strategy by which lessons are chosen"),
      list.integer("--seed", options.seed, {}, "Seed of all random streams"),
      list.text("--study", options.study, "STUDY", "Built-in study or file with the learner types"),
      list.set(options.set)};
  auto from = list.text("--from", options.from, "DIR", "Replay a team of this run folder");
  auto team = list.text("--team", options.team, "N", "Number of the team, as in teams.csv");
  list.integer("--forecast", options.forecast, {0, 100'000},
               "Forecast the session from this many imagined teams of the same kind");
  from.needs(team);
  team.needs(from);
  for (const auto& other : others) from.excludes(other);
  list.json();
}

int run(const TeachOptions& options, Console& console) {
  auto assignment = options.from.empty() ? from_options(options) : from_run_folder(options);
  if (options.forecast) assignment.spec.forecast_sessions = *options.forecast;
  const Atlas atlas{std::move(assignment.domain)};
  require_something_to_teach(atlas);
  const auto transcript = transcribe(atlas, assignment.spec, assignment.address);
  console.print([&] { return transcript_json(atlas, transcript); }, [&] { return to_text(atlas, transcript); });
  return 0;
}

}  // namespace

void add_teach(Commands& commands) {
  commands.add<TeachOptions>(
      "teach", "Teach one simulated team and print a transcript",
      {"kith teach item-delivery --group NNP --strategy joint", "kith teach --from results/paper --team 17"}, declare,
      run);
}

}  // namespace kith::cli
