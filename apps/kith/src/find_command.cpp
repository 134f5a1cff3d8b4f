#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "build_facts.hpp"
#include "command.hpp"
#include "input.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/variation.hpp"
#include "kith/explain/board_json.hpp"
#include "kith/explain/contrast.hpp"
#include "kith/explain/legend.hpp"
#include "kith/explain/picture.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/target.hpp"
#include "kith/explain/words.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/files/atomic_file.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct FindOptions {
  std::string domain;
  std::vector<std::string> constraint;  ///< A normal or a sentence, in one argument or in several; empty: list all.
  bool test = false;                    ///< Wanted for a test rather than for a demonstration.
  std::string out;                      ///< Where the world goes as a domain file; empty: nowhere.
};

const char* name_of(Purpose purpose) { return purpose == Purpose::kTeach ? "teach" : "test"; }

void list_constraints(const Atlas& atlas, Console& console) {
  const auto all = isolated_constraints(atlas);
  if (console.json()) {
    Json constraints = Json::array();
    for (const auto& one : all) {
      auto json = sentences_json(atlas.domain(), std::vector{one.constraint}).front();
      json["teaching"] = one.teaching;
      json["testing"] = one.testing;
      constraints.push_back(std::move(json));
    }
    console.print_json({{"schema", "kith.find/1"},
                        {"program", program_name()},
                        {"domain", board_domain_json(atlas.domain())},
                        {"constraints", constraints}});
    return;
  }
  TextTable table{"rrl"};
  table.add({"teach", "test", "constraint"});
  for (const auto& one : all) {
    table.add({std::to_string(one.teaching), std::to_string(one.testing), described(atlas.domain(), one.constraint)});
  }
  console.print("start states that teach or test one constraint and nothing else\n" + table.text(console));
}

std::string reason_of(const Atlas& atlas, StartIndex start, const HalfSpace& constraint) {
  const auto contrast = contrast_for(atlas, start, constraint);
  return contrast ? reason(atlas, *contrast) : in_words(atlas.domain(), constraint);
}

void print_finding(const Atlas& atlas, StartIndex start, const HalfSpace& constraint, Purpose purpose,
                   Console& console) {
  const auto& domain = atlas.domain();
  const auto id = atlas.id(start);
  const auto path = atlas.trajectory(start);
  // Without tables whole paths that people could expect are not known.
  const bool is_rough = purpose == Purpose::kTest && atlas.find_tables() == nullptr;
  console.print(fmt::format("W{}, start {} {} exactly this{}: {}\n", world_text(domain, id.mdp).substr(1),
                            id.start.value(), purpose == Purpose::kTeach ? "teaches" : "tests",
                            is_rough ? ", as far as single other actions tell" : "", described(domain, constraint)) +
                wrapped(reason_of(atlas, start, constraint), kTextWidth) + "\n" + start_and_path(domain, id, path, 2) +
                "  the robot: " + actions_text(domain, id.mdp, path) + "\n\n" + legend(domain, 0));
}

void print_finding_json(const Atlas& atlas, StartIndex start, const HalfSpace& constraint, Purpose purpose,
                        Console& console) {
  const auto& domain = atlas.domain();
  const auto id = atlas.id(start);
  auto json = board_json(domain, id);
  json.update(path_json(domain, id.mdp, atlas.trajectory(start)));
  json["reason"] = reason_of(atlas, start, constraint);
  console.print_json({{"schema", "kith.find/1"},
                      {"program", program_name()},
                      {"domain", board_domain_json(domain)},
                      {"purpose", name_of(purpose)},
                      {"constraint", sentences_json(domain, std::vector{constraint}).front()},
                      {"found", std::move(json)}});
}

Error infeasible(const std::string& id, const std::string& message, const std::string& hint) {
  return Error{ErrorKind::kInfeasible, message, {{.id = id, .message = message, .hint = hint, .infeasible = true}}};
}

Error not_a_file_of_its_own(const Domain& domain, MdpIndex world) {
  return infeasible(
      "E1112",
      fmt::format("{} of '{}' cannot be written as a domain file of its own", world_text(domain, world), domain.id()),
      domain.map() ? "its worlds are listed, or share layers: write its [map] by hand, one map and nothing optional"
                   : "it has no map: copy its tables without the rows of other worlds");
}

// The world as a domain file of its own.
void write_world(const FindOptions& options, const Domain& domain, MdpIndex world, Console& console) {
  std::optional<std::string> text;
  if (const auto map = domain.map()) {
    text = with_one_map(read_named(options.domain).text, fmt::format("{}-{}", domain.id(), world.value()),
                        map->draw(world, std::nullopt));
  }
  if (!text) throw not_a_file_of_its_own(domain, world);
  write_file_atomically(options.out, *text);
  console.info(fmt::format("world in {}; kith lesson {} shows it", options.out, options.out));
}

// Whether any start conveys it, and what comes with it.
std::string why_none(const Atlas& atlas, const HalfSpace& constraint, Purpose purpose) {
  const auto why = why_not_isolated(atlas, constraint, purpose);
  const std::string verb = name_of(purpose);
  const auto third_person = verb + (purpose == Purpose::kTeach ? "es" : "s");
  if (!why.nearest) return "none " + third_person + " it together with something else either";
  std::vector<std::string> besides;
  for (const auto& beside : why.besides) besides.push_back(described(atlas.domain(), beside));
  const auto id = atlas.id(*why.nearest);
  return fmt::format("{} can {} it, but never alone: the nearest, {}, start {}, also {} {}",
                     counted(why.conveying, "start state"), verb, world_text(atlas.domain(), id.mdp), id.start.value(),
                     third_person, besides.empty() ? "more than it says" : listed(besides));
}

Error not_found(const Atlas& atlas, const HalfSpace& constraint, Purpose purpose) {
  const auto message =
      fmt::format("no start state of '{}' {} exactly {}", atlas.domain().id(),
                  purpose == Purpose::kTeach ? "teaches" : "tests", described(atlas.domain(), constraint));
  const std::string ties = leaves_out_ties(atlas) ? "; comparisons of equally good paths do not count here" : "";
  return infeasible("E1111", message,
                    why_none(atlas, constraint, purpose) + ties + "; `kith find DOMAIN` lists what can be isolated");
}

void declare(OptionList& list, FindOptions& options) {
  list.domain(options.domain).required();
  list.texts("constraint", options.constraint, "CONSTRAINT",
             "A normal, such as '(-1,0,2)', or its sentence; without one, all that can be isolated are listed");
  list.flag("--test", options.test, "Find a world for a test, not for a demonstration");
  list.text("-o,--out", options.out, "FILE", "Write the world to this file, as a domain of its own");
  list.json();
}

int run(const FindOptions& options, Console& console) {
  const WorkNotice notice{console, "looking through " + options.domain};
  const Atlas atlas{load_domain(options.domain)};
  const auto wanted = fmt::format("{}", fmt::join(options.constraint, " "));
  if (wanted.empty()) {
    list_constraints(atlas, console);
    return 0;
  }
  const auto constraint = parse_constraint(atlas, wanted);
  const auto purpose = options.test ? Purpose::kTest : Purpose::kTeach;
  const auto start = simplest_isolating(atlas, constraint, purpose);
  if (!start) throw not_found(atlas, constraint, purpose);
  if (!options.out.empty()) write_world(options, atlas.domain(), atlas.id(*start).mdp, console);
  const auto print = console.json() ? print_finding_json : print_finding;
  print(atlas, *start, constraint, purpose, console);
  return 0;
}

}  // namespace

void add_find(Commands& commands) {
  commands.add<FindOptions>("find", "Find a world that teaches or tests exactly one constraint",
                            {"kith find item-delivery", "kith find item-delivery '(-1,0,2)' --test",
                             "kith find item-delivery '(-1,0,2)' -o world.toml"},
                            declare, run);
}

}  // namespace kith::cli
