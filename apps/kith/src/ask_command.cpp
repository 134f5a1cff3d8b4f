#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "build_facts.hpp"
#include "command.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/board_json.hpp"
#include "kith/explain/legend.hpp"
#include "kith/explain/picture.hpp"
#include "kith/explain/question.hpp"
#include "kith/explain/runs.hpp"
#include "kith/explain/words.hpp"
#include "kith/explain/wrapped.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct AskOptions {
  std::string domain;
  std::vector<std::string> question;  ///< In one argument or in several.
};

// Nothing where nothing is left to chance.
std::vector<PolicyRun> runs_from(const Atlas& atlas, StartIndex start) {
  constexpr std::size_t kRuns = 10;
  if (atlas.domain().is_exact()) return {};
  auto random = RandomStream{1}.split("runs").split(start.value());
  return several_runs(atlas, start, kRuns, random);
}

Json path_and_chance(const Domain& domain, MdpIndex world, const Trajectory& path) {
  const auto chance = chance_of_path(domain, world, path);
  auto json = path_json(domain, world, path);
  json["chance"] = chance ? Json(*chance) : Json{};
  return json;
}

Json reply_json(const Atlas& atlas, const Reply& reply) {
  const auto& domain = atlas.domain();
  Json examples = Json::array();
  for (const auto& example : reply.examples) {
    const auto id = atlas.id(example.start);
    auto json = board_json(domain, id);
    json.update(path_and_chance(domain, id.mdp, example.path));
    json["text"] = example.text;
    json["alternative"] = nullptr;
    if (example.alternative) json["alternative"] = path_and_chance(domain, id.mdp, *example.alternative);
    json["runs"] = runs_json(domain, id.mdp, runs_from(atlas, example.start));
    json["decisive"] = example.decisive ? step_json(domain, id.mdp, example.path, *example.decisive) : Json{};
    examples.push_back(std::move(json));
  }
  return {{"schema", "kith.ask/1"},     {"program", program_name()}, {"domain", board_domain_json(domain)},
          {"question", reply.question}, {"answer", reply.text},      {"examples", examples}};
}

// The actions, and how likely the path is where chance has a part.
std::string path_text(const Domain& domain, MdpIndex world, const Trajectory& path) {
  const auto chance = chance_in_words(domain, world, path);
  return actions_text(domain, world, path) + (chance.empty() ? "" : " (" + chance + ")");
}

std::string reply_text(const Atlas& atlas, const Reply& reply, const Console& console) {
  const auto& domain = atlas.domain();
  std::string text = console.dim(reply.question) + "\n" + wrapped(reply.text, kTextWidth) + "\n";
  for (const auto& example : reply.examples) {
    text += "\n" + wrapped(example.text, kTextWidth) + "\n" +
            start_and_path(domain, atlas.id(example.start), example.path, 2);
    const auto world = atlas.id(example.start).mdp;
    const auto add = [&](const std::string& line) { text += "  " + wrapped(line, kTextWidth - 2, "  ") + "\n"; };
    const auto runs = runs_from(atlas, example.start);
    if (example.alternative || !runs.empty() || example.path.repeats_from)
      add("the robot: " + path_text(domain, world, example.path));
    if (!runs.empty()) add(runs_in_words(domain, world, runs));
    if (example.alternative) add("otherwise: " + path_text(domain, world, *example.alternative));
  }
  return text + "\n" + legend(domain, 0);
}

void declare(OptionList& list, AskOptions& options) {
  list.domain(options.domain).required();
  list.texts("question", options.question, "QUESTION", "Begins with when, where, why, what or how much").required();
  list.json();
}

int run(const AskOptions& options, Console& console) {
  const WorkNotice notice{console, "looking through " + options.domain};
  const Atlas atlas{load_domain(options.domain)};
  const auto reply = answer_question(atlas, fmt::format("{}", fmt::join(options.question, " ")));
  console.print([&] { return reply_json(atlas, reply); }, [&] { return reply_text(atlas, reply, console); });
  return 0;
}

}  // namespace

void add_ask(Commands& commands) {
  commands.add<AskOptions>("ask", "Answer a question about the robot with demonstrations",
                           {"kith ask item-delivery 'when does it recharge?'",
                            "kith ask item-delivery 'why up, not left, at (4,3) carrying the parcel?'"},
                           declare, run);
}

}  // namespace kith::cli
