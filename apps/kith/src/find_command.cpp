#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "build_facts.hpp"
#include "command.hpp"
#include "input.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/variation.hpp"
#include "kith/explain/contrast.hpp"
#include "kith/explain/reason.hpp"
#include "kith/explain/target.hpp"
#include "kith/explain/words.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/present/board_json.hpp"
#include "kith/present/legend.hpp"
#include "kith/present/picture.hpp"
#include "kith/present/wrapped.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct FindOptions {
  std::string domain;
  std::vector<std::string> constraint;  ///< A normal or a sentence, in one argument or in several; empty: list all.
  bool test = false;                    ///< Wanted for a test rather than for a demonstration.
  std::size_t changes = 2;              ///< Most cells in which a world that is made may differ.
  bool no_make = false;                 ///< Make no world where the family has none.
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

// A start that teaches or tests the constraint alone, in the family or in a world that was made.
struct FoundDemo {
  const Atlas& atlas;
  StartIndex demo;
  const MadeWorld* made;  // nothing: it is in the family
};

std::string reason_of(const Atlas& atlas, StartIndex demo, const HalfSpace& constraint) {
  const auto contrast = contrast_for(atlas, demo, constraint);
  return contrast ? reason(atlas, *contrast) : in_words(atlas.domain(), constraint);
}

void print_finding(const Domain& family, const FoundDemo& found, const HalfSpace& constraint, Purpose purpose,
                   Console& console) {
  const auto& domain = found.atlas.domain();
  const auto id = found.atlas.id(found.demo);
  const auto path = found.atlas.trajectory(found.demo);
  const std::string verb = purpose == Purpose::kTeach ? "teaches" : "tests";
  // Without tables whole paths that people could expect are not known.
  const bool is_rough = purpose == Purpose::kTest && found.atlas.find_tables() == nullptr;
  std::string text;
  if (found.made == nullptr) {
    text = fmt::format("W{}, start {} {} exactly this{}: {}\n", world_text(domain, id.mdp).substr(1), id.start.value(),
                       verb, is_rough ? ", as far as single other actions tell" : "", described(domain, constraint));
  } else {
    std::vector<std::string> changes;
    for (const auto& change : found.made->changes) changes.push_back(change_in_words(*family.map(), change));
    text = wrapped(fmt::format("No world of {} {} exactly this: {}. One was made from world {}: {}.", family.id(), verb,
                               described(domain, constraint), found.made->base.value(), listed(changes)),
                   kTextWidth) +
           "\n";
  }
  text += wrapped(reason_of(found.atlas, found.demo, constraint), kTextWidth) + "\n" +
          start_and_path(domain, id, path, 2) + "  the robot: " + actions_text(domain, id.mdp, path) + "\n\n" +
          legend(domain, 0);
  console.print(text);
}

void print_finding_json(const FoundDemo& found, const HalfSpace& constraint, Purpose purpose, Console& console) {
  const auto& domain = found.atlas.domain();
  const auto id = found.atlas.id(found.demo);
  auto json = board_json(domain, id);
  json.update(path_json(domain, id.mdp, found.atlas.trajectory(found.demo)));
  json["reason"] = reason_of(found.atlas, found.demo, constraint);
  Json made = nullptr;
  if (found.made != nullptr) {
    const auto map = domain.map().value();  // worlds are made by changing a map
    made = {{"from", found.made->base.value()}, {"changes", Json::array()}, {"domain", found.made->text}};
    for (const auto& change : found.made->changes) {
      made["changes"].push_back({{"cell", {change.cell.x, map.height() + 1 - change.cell.y}},
                                 {"from", std::string{change.from}},
                                 {"to", std::string{change.to}}});
    }
  }
  console.print_json({{"schema", "kith.find/1"},
                      {"program", program_name()},
                      {"domain", board_domain_json(domain)},
                      {"purpose", name_of(purpose)},
                      {"constraint", sentences_json(domain, std::vector{constraint}).front()},
                      {"found", std::move(json)},
                      {"made", std::move(made)}});
}

Error infeasible(const std::string& id, const std::string& message, const std::string& hint) {
  return Error{ErrorKind::kInfeasible, message, {{.id = id, .message = message, .hint = hint, .infeasible = true}}};
}

Error not_a_file_of_its_own(const Domain& domain, MdpIndex world) {
  const auto by_export =
      fmt::format("it has no map; kith export --mdp {} writes it, with a domain file beside it", world.value());
  return infeasible(
      "E1112",
      fmt::format("{} of '{}' cannot be written as a domain file of its own", world_text(domain, world), domain.id()),
      domain.map() ? "its worlds are listed, or share layers: write its [map] by hand, one map and nothing optional"
                   : by_export);
}

// The world as a domain file of its own.
void write_world(const std::string& out, const std::string& family_text, const FoundDemo& found, Console& console) {
  std::optional<std::string> text;
  if (found.made != nullptr) {
    text = found.made->text;
  } else {
    const auto& domain = found.atlas.domain();
    const auto world = found.atlas.id(found.demo).mdp;
    if (const auto map = domain.map()) {
      text =
          with_one_map(family_text, fmt::format("{}-{}", domain.id(), world.value()), map->draw(world, std::nullopt));
    }
    if (!text) throw not_a_file_of_its_own(domain, world);
  }
  write_file_atomically(out, *text);
  console.info(fmt::format("world in {}; kith curriculum {} shows it", out, out));
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

Error not_found(const Atlas& atlas, const HalfSpace& constraint, Purpose purpose, const FindOptions& options) {
  auto message = fmt::format("no start state of '{}' {} exactly {}", atlas.domain().id(),
                             purpose == Purpose::kTeach ? "teaches" : "tests", described(atlas.domain(), constraint));
  const bool can_make = can_make_worlds(atlas.domain());
  if (!options.no_make && can_make) {
    message +=
        fmt::format(", and no world was found that differs in {} at most and does", counted(options.changes, "cell"));
  }
  const auto next = options.no_make && can_make ? "without --no-make a world is made"
                    : can_make ? fmt::format("--changes {} also tries worlds that differ more", options.changes + 1)
                               : "`kith find DOMAIN` lists what can be isolated";
  const std::string ties = leaves_out_ties(atlas) ? "; comparisons of equally good paths do not count here" : "";
  return infeasible("E1111", message, why_none(atlas, constraint, purpose) + ties + "; " + next);
}

void declare(OptionList& list, FindOptions& options) {
  list.domain(options.domain).required();
  list.texts("constraint", options.constraint, "CONSTRAINT",
             "A normal, such as '(-1,0,2)', or its sentence; without one, all that can be isolated are listed");
  list.flag("--test", options.test, "For a test rather than for a demonstration");
  list.flag("--no-make", options.no_make, "Do not make a world where the domain has none");
  list.integer("--changes", options.changes, {1, 6}, "Most cells in which a world that is made may differ");
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
  const auto demo = simplest_isolating(atlas, constraint, purpose);
  std::optional<MadeWorld> made;
  const auto text = !demo || !options.out.empty() ? read_named(options.domain).text : std::string{};
  if (!demo && !options.no_make) made = make_world(atlas, text, constraint, purpose, {.max_changes = options.changes});
  if (!demo && !made) throw not_found(atlas, constraint, purpose, options);
  const FoundDemo found = demo ? FoundDemo{atlas, *demo, nullptr} : FoundDemo{made->atlas, made->demo, &*made};
  if (!options.out.empty()) write_world(options.out, text, found, console);
  if (console.json()) {
    print_finding_json(found, constraint, purpose, console);
  } else {
    print_finding(atlas.domain(), found, constraint, purpose, console);
  }
  return 0;
}

}  // namespace

void add_find(Commands& commands) {
  commands.add<FindOptions>("find", "Find or make a world that teaches or tests exactly one constraint",
                            {"kith find item-delivery", "kith find item-delivery '(-1,0,2)' --test",
                             "kith find item-delivery '(-1,0,2)' -o world.toml"},
                            declare, run);
}

}  // namespace kith::cli
