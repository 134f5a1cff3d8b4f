#include "kith/live/live_study.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "kith/core/distributions.hpp"
#include "kith/core/error.hpp"
#include "kith/files/sha256.hpp"
#include "kith/live/world_json.hpp"
#include "kith/study/session_forecasts.hpp"
#include "live_texts.hpp"
#include "message_json.hpp"
#include "room_view.hpp"

namespace kith {
namespace {

constexpr std::size_t kMostTextBytes = std::size_t{1} << 20u;

std::string read_live_file(const std::filesystem::path& path, const std::string& key) {
  std::error_code failure;
  std::ifstream file{path, std::ios::binary};
  if (!std::filesystem::is_regular_file(path, failure) || !file) {
    throw Error{ErrorKind::kIo, "cannot read '" + path.string() + "', the file that group." + key + " names"};
  }
  std::string text{std::istreambuf_iterator<char>{file}, {}};
  if (text.size() > kMostTextBytes) {
    throw Error{ErrorKind::kInvalidInput, "'" + path.string() + "' is larger than 1 MiB"};
  }
  return text;
}

LiveLanguage parse_language(const std::string& text, const std::string& name) {
  const auto refuse = [&](const std::string& why) {
    return Error{ErrorKind::kInvalidInput, "'" + name + "' is not a file of texts: " + why};
  };
  const auto json = Json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object()) throw refuse("it is not a JSON object");
  LiveLanguage language;
  for (const auto& [key, value] : json.items()) {
    if (key == "lang" && value.is_string()) {
      language.code = value.get<std::string>();
    } else if (key == "dir" && (value == "ltr" || value == "rtl")) {
      language.direction = value.get<std::string>();
    } else if (key == "strings" && value.is_object()) {
      for (const auto& [id, string] : value.items()) {
        if (!string.is_string()) throw refuse("strings." + id + " is not a text");
        language.strings.emplace(id, string.get<std::string>());
      }
    } else {
      throw refuse("'" + key + R"(' is not one of lang, dir ("ltr" or "rtl") and strings)");
    }
  }
  return language;
}

void require_teachable(const std::vector<StrategyChoice>& strategies) {
  for (const auto& strategy : strategies) {
    if (!strategy.kind.needs_truth) continue;
    throw Error{ErrorKind::kInvalidInput, "the strategy '" + strategy.name +
                                              "' reads what simulated people believe, so it cannot teach real ones: "
                                              "remove it from [design]"};
  }
}

// What sessions of people cannot do.
void require_whole_group(const StudySpec& spec) {
  if (!spec.teaching.release) return;
  throw Error{ErrorKind::kInvalidInput, "'stop.release' works in simulated studies only: remove it to teach people"};
}

void require_small_worlds(const Domain& domain) {
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const auto states = domain.mdp(m).num_states() + domain.mdp(m).num_terminals();
    if (states <= kMaxLiveStates) continue;
    throw Error{ErrorKind::kInfeasible,
                "world " + std::to_string(m.value()) + " of domain '" + domain.id() + "' has " +
                    std::to_string(states) + " states; people can be taught about worlds of at most " +
                    std::to_string(kMaxLiveStates) + " states, because each browser gets the table of all moves"};
  }
}

bool has_tests(const Atlas& atlas) {
  for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
    if (!atlas.tests_for(c).empty()) return true;
  }
  return false;
}

// The atlas without tests that people could not answer.
std::shared_ptr<const Atlas> with_answerable_tests(std::shared_ptr<const Atlas> atlas) {
  std::vector<bool> is_answerable(atlas->num_states());
  for (std::size_t i = 0; i < is_answerable.size(); ++i) {
    is_answerable[i] = !atlas->is_candidate(StartIndex{i}) || answerable_path(*atlas, StartIndex{i});
  }
  if (std::find(is_answerable.begin(), is_answerable.end(), false) == is_answerable.end()) return atlas;
  auto answerable = std::make_shared<const Atlas>(atlas->with_tests(is_answerable));
  if (has_tests(*atlas) && !has_tests(*answerable)) {
    throw Error{ErrorKind::kInfeasible, "people cannot be asked about domain '" + atlas->domain().id() +
                                            "': from no start do the robot's likeliest steps lead to the end within " +
                                            std::to_string(max_answer_actions(atlas->domain())) + " steps"};
  }
  return answerable;
}

// A start where there is room to move, which no test would use if possible, simple to look at.
StartIndex find_sandbox(const Atlas& atlas) {
  constexpr std::size_t kRoom = 4;
  std::optional<StartIndex> best;
  std::tuple<bool, bool, int, std::size_t> best_rank;
  for (std::size_t i = 0; i < atlas.num_states(); ++i) {
    const StartIndex start{i};
    const bool tests = atlas.is_candidate(start) && !atlas.tested_constraints(start).without(atlas.prior()).empty();
    const auto steps = std::min(kRoom, atlas.trajectory(start).actions.size());
    const std::tuple rank{steps < 2, tests, atlas.complexity(start), kRoom - steps};
    if (!best || rank < best_rank) {
      best = start;
      best_rank = rank;
    }
  }
  return best.value();
}

// Starts that test the constraints of the robot's policy, each in turn.
std::vector<StartIndex> draw_screening(const Atlas& atlas, std::size_t n, RandomStream random) {
  std::vector<StartIndex> chosen;
  const auto unused = [&](std::span<const StartIndex> candidates) {
    std::vector<StartIndex> left;
    for (const auto start : candidates) {
      const bool is_new = std::none_of(chosen.begin(), chosen.end(), [&](StartIndex other) {
        return atlas.trajectory_class(other) == atlas.trajectory_class(start);
      });
      if (is_new) left.push_back(start);
    }
    return left;
  };
  const auto constraints = atlas.policy_bec().without(atlas.prior()).members();
  std::size_t barren = 0;  // constraints in a row that nothing new tests
  for (std::size_t i = 0; chosen.size() < n && !constraints.empty() && barren < constraints.size(); ++i) {
    const auto left = unused(atlas.tests_for(constraints[i % constraints.size()]));
    barren = left.empty() ? barren + 1 : 0;
    if (!left.empty()) chosen.push_back(left[uniform_index(left.size(), random)]);
  }
  return chosen;
}

// At least one group that can be taught.
void require_cells(const LiveStudy& study) {
  if (!live_cells(study).empty()) return;
  throw Error{ErrorKind::kInvalidInput,
              "this study has no group that people can be taught in: its only strategy, 'baseline', teaches one person "
              "at a time, and every composition has more. Add a composition of one learner to 'compositions' of "
              "[design], such as \"" +
                  study.spec.compositions.front().substr(0, 1) +
                  "\" (and let 'size' of [group] allow it), or another "
                  "strategy to 'strategies'"};
}

// Nobody must wait for a place that cannot exist.
void require_places(const LiveStudy& study) {
  if (!study.seats_by_ability()) return;
  const auto cells = live_cells(study);
  for (const bool high : {false, true}) {
    if (std::any_of(cells.begin(), cells.end(), [&](const LiveCell& cell) { return has_place_for(study, cell, high); }))
      continue;
    throw Error{ErrorKind::kInvalidInput,
                std::string{"people whose estimate of ability is "} + (high ? "high" : "low") +
                    " would wait for nothing: no composition has a place for them. Change the compositions, or "
                    "'high' of group.screening"};
  }
}

std::string filled_up(std::string composition, std::size_t size) {
  if (composition.size() < size) composition.append(size - composition.size(), composition.back());
  return composition;
}

}  // namespace

std::shared_ptr<const LiveStudy> make_live_study(const Study& study, std::shared_ptr<const Atlas> atlas,
                                                 const std::filesystem::path& folder, std::string domain_text) {
  if (study.variants.size() != 1) {
    throw Error{ErrorKind::kInvalidInput,
                "a study with varied keys cannot be run with people: remove 'vary' from [design]"};
  }
  auto live = std::make_shared<LiveStudy>();
  live->spec = study.variants.front();
  live->domain_text = std::move(domain_text);
  require_teachable(live->spec.strategies);
  require_whole_group(live->spec);
  auto& group = live->spec.group;
  require_small_worlds(atlas->domain());
  atlas = with_answerable_tests(std::move(atlas));
  if (!group.consent_file.empty()) {
    group.consent_text = paragraphs_of(read_live_file(folder / group.consent_file, "consent_file"));
    if (group.consent_text.empty()) {
      throw Error{ErrorKind::kInvalidInput, "the consent text '" + group.consent_file + "' is empty"};
    }
    group.consent_file.clear();
  }
  if (!group.language.empty()) {
    live->language = parse_language(read_live_file(folder / group.language, "language"), group.language);
  }
  fill_in_texts(group, atlas->domain());
  live->sandbox = find_sandbox(*atlas);
  live->screening = draw_screening(*atlas, group.screening.tests, RandomStream{live->spec.seed}.split("screening"));
  if (live->screening.size() < group.screening.tests) {
    throw Error{ErrorKind::kInfeasible, "the domain has only " + std::to_string(live->screening.size()) +
                                            " different tests for a screening of " +
                                            std::to_string(group.screening.tests)};
  }
  std::string identity = atlas->domain().id() + '/' + std::to_string(max_answer_actions(atlas->domain()));
  for (MdpIndex m{0}; m.value() < atlas->domain().num_mdps(); ++m) {
    identity += '/' + std::to_string(atlas->domain().mdp(m).num_states()) + atlas->domain().describe_world(m);
  }
  live->key = sha256(identity).substr(0, 8);
  if (const auto& known = live->spec.teaching.known) live->update = update_in_words(*atlas, *known);
  live->legend = std::make_shared<const Json>(board_legend(atlas->domain()));
  live->atlas = std::move(atlas);
  require_cells(*live);
  require_places(*live);
  if (live->spec.forecast_sessions > 0) {
    TeachingCache cache{live->atlas};
    for (const auto& [strategy, composition] : live_cells(*live)) {
      live->imagined[{strategy, composition}] =
          imagine_sessions(*live->atlas, cache, live->spec, strategy, composition, live->spec.forecast_sessions);
    }
  }
  return live;
}

std::vector<LiveCell> live_cells(const LiveStudy& study) {
  std::vector<LiveCell> cells;
  for (const auto& composition : study.spec.compositions) {
    const auto seats = filled_up(composition, study.group().size);
    for (const auto& strategy : study.spec.strategies) {
      if (strategy.is_baseline() && seats.size() > 1) continue;
      LiveCell cell{strategy.name, seats};
      if (std::find(cells.begin(), cells.end(), cell) == cells.end()) cells.push_back(std::move(cell));
    }
  }
  return cells;
}

Json stored_json(const GroupOptions& group) {
  const bool has_text = std::ranges::any_of(
      group.questions, [](const GroupQuestion& one) { return one.kind == GroupQuestion::Kind::kText; });
  return {{"names", group.ask_name},
          {"text", has_text},
          {"questions", !group.questions.empty()},
          {"query", group.collect_query},
          {"screening", group.screening.tests > 0},
          {"discussion", group.discussion.choice.is_held()}};
}

namespace {

// "(MINUTES)" or "[your address]": what a template leaves to its author.
std::optional<std::string> placeholder_in(const std::string& text) {
  for (const auto& [open, close] : {std::pair{'(', ')'}, std::pair{'[', ']'}}) {
    for (auto begin = text.find(open); begin != std::string::npos; begin = text.find(open, begin + 1)) {
      const auto end = text.find(close, begin);
      if (end == std::string::npos) break;
      const auto inner = text.substr(begin + 1, end - begin - 1);
      const bool is_link = close == ']' && text.substr(end + 1, 1) == "(";
      const bool has_letters = inner.find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") != std::string::npos;
      const bool is_shouted = inner.size() > 2 && has_letters &&
                              inner.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ ,/-") == std::string::npos;
      if (is_shouted || (open == '[' && !is_link && !inner.empty())) return text.substr(begin, end - begin + 1);
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<Diagnostic> warnings_for_people(const StudySpec& spec, const std::filesystem::path& folder) {
  const auto& group = spec.group;
  std::vector<Diagnostic> warnings;
  const auto warn = [&](const std::string& id, const std::string& file, const std::string& message,
                        const std::string& hint) {
    warnings.push_back({.severity = Severity::kWarning, .id = id, .message = message, .file = file, .hint = hint});
  };
  auto texts = group.consent_text;
  std::string file;
  if (!group.consent_file.empty()) {
    file = (folder / group.consent_file).string();
    std::error_code failure;
    if (!std::filesystem::is_regular_file(file, failure)) {
      warn("W1601", file, "the file of the consent text cannot be read",
           "kith serve needs it; write it beside the study");
    } else {
      texts = paragraphs_of(read_live_file(file, "consent_file"));
    }
  }
  if (!group.language.empty() && !std::filesystem::is_regular_file(folder / group.language)) {
    warn("W1601", (folder / group.language).string(), "the file of the page's language cannot be read",
         "kith serve needs it; write it beside the study");
  }
  texts.insert(texts.end(), group.story.begin(), group.story.end());
  texts.push_back(group.goal);
  for (const auto& text : texts) {
    const auto found = placeholder_in(text);
    if (found) warn("W1602", file, "participants would read '" + *found + "'", "write what belongs there");
  }
  return warnings;
}

Json live_study_json(const LiveStudy& study) {
  Json strategies = Json::array(), types = Json::array(), compositions = Json::array();
  std::size_t size = 0;
  for (const auto& cell : live_cells(study)) {
    const bool is_new = std::find(compositions.begin(), compositions.end(), cell.composition) == compositions.end();
    if (is_new) compositions.push_back(cell.composition);
    size = std::max(size, cell.composition.size());
  }
  for (const auto& strategy : study.spec.strategies) {
    strategies.push_back({{"name", strategy.name}, {"description", std::string{strategy.kind.description}}});
  }
  for (const auto& type : study.spec.learner_types) {
    types.push_back({{"letter", std::string{type.letter}}, {"label", type.label}});
  }
  const auto& group = study.group();
  Json info{{"id", study.spec.id},
            {"title", study.spec.title},
            {"domain", study.atlas->domain().id()},
            {"strategies", strategies},
            {"types", types},
            {"compositions", compositions},
            {"size", size},
            {"dropout", std::string{name_of(group.dropout.policy)}},
            {"grace_s", group.dropout.grace_s},
            {"stores", stored_json(group)},
            {"time", Json::object()}};
  for (const auto& key : kGroupTimeKeys) info["time"][std::string{key.name}] = group.time.*key.member;
  return info;
}

Json language_json(const LiveStudy& study) {
  return {{"lang", study.language.code}, {"dir", study.language.direction}, {"strings", study.language.strings}};
}

Json collected_query(const LiveStudy& study, const Json& query) {
  constexpr std::size_t kMostBytes = 200;
  Json collected = Json::object();
  if (!query.is_object()) return collected;
  for (const auto& name : study.group().collect_query) {
    auto value = read_within<std::string>(query.value(name, Json{}), {.longest = kMostBytes});
    if (value) collected[name] = *std::move(value);
  }
  return collected;
}

std::string completion_code(const LiveStudy& study, std::string_view salt, std::string_view room, std::size_t seat) {
  // Without letters and digits that look alike.
  constexpr std::string_view kLetters = "23456789ABCDEFGHJKMNPQRSTUVWXYZ";
  Sha256 hash;
  hash.update(std::string{salt} + '\n' + std::string{room} + '\n' + std::to_string(seat));
  const auto bytes = std::move(hash).digest();
  auto code = study.group().completion.prefix;
  if (!code.empty()) code += '-';
  for (std::size_t i = 0; i < 10; ++i) code += kLetters[static_cast<unsigned char>(bytes[i]) % kLetters.size()];
  return code;
}

}  // namespace kith
