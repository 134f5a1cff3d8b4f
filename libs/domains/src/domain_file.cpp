#include "kith/domains/domain_file.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <utility>

#include "domain_data.hpp"
#include "dynamics.hpp"
#include "family.hpp"
#include "kith/core/error.hpp"
#include "kith/toml/reader.hpp"
#include "reward.hpp"

namespace kith {
namespace {

constexpr const char* kSchema = "kith.domain/1";

// Another schema has other keys: every further message would only confuse.
bool check_schema(TomlReader& file) {
  const auto schema = file.string("schema", Presence::kRequired);
  if (!schema) return false;
  if (*schema == kSchema) return true;
  file.report().error("E0106", file.content().find("schema")->place(),
                      "'" + *schema + "' is not a schema of domain files",
                      std::string{"write schema = \""} + kSchema + '"');
  return false;
}

void check_id(TomlReader& file, const std::string& id) {
  const bool good = !id.empty() && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
  if (good) return;
  file.report().error("E0115", file.content().find("id")->place(), "'" + id + "' cannot be an id",
                      "use lower-case letters, digits and '-'");
}

// Something must end an episode, else there is nothing to plan for.
void check_has_goal(const detail::World& world, const detail::Dynamics& dynamics, TomlReport& report) {
  const auto& actions = dynamics.actions;
  if (world.some_goal || std::find(actions.begin(), actions.end(), detail::Action::kExit) != actions.end()) return;
  report.error("E0210", world.map_place, "the map has no goal",
               "declare a symbol with goal = true or destination = \"ITEM\", or the action \"exit\"");
}

Domain::Data data_from(std::string id, std::string title, detail::World world, const detail::Dynamics& dynamics,
                       detail::Reward reward, std::vector<DomainMember> members) {
  Domain::Data data;
  data.id = std::move(id);
  data.title = std::move(title);
  data.feature_names = dynamics.feature_names();
  for (const detail::Action action : dynamics.actions) {
    data.action_names.push_back(detail::all_action_names()[static_cast<std::size_t>(action)]);
  }
  data.feature_words = std::move(reward.words);
  data.weights = std::move(reward.weights);
  data.prior = std::move(reward.prior);
  data.max_steps = dynamics.max_steps;
  for (const detail::Item& item : world.items) data.item_names.push_back(item.name);
  data.layout = detail::StateLayout{world};
  data.world = std::move(world);
  data.members = std::move(members);
  data.describe_members();
  return data;
}

std::optional<Domain> read_document(const TomlDocument& document, const DomainLimits& limits, TomlReport& report) {
  TomlReader file{document.root, {0, 1, 1, 1}, "the file", report};
  if (!check_schema(file)) return std::nullopt;
  const auto id = file.string("id", Presence::kRequired);
  if (id) check_id(file, *id);
  const auto title = file.string("title", Presence::kOptional);
  detail::World world = detail::read_world(file);
  const detail::Dynamics dynamics = detail::read_dynamics(file, world);
  detail::Reward reward = detail::read_reward(file, dynamics);
  file.finish();
  if (world.is_sound) check_has_goal(world, dynamics, report);
  if (report.has_errors()) return std::nullopt;

  std::vector<DomainMember> members = detail::build_family(world, dynamics, limits, report);
  if (report.has_errors()) return std::nullopt;
  detail::check_optimum(world, dynamics, reward, members, report);
  if (report.has_errors()) return std::nullopt;
  return Domain{data_from(*id, title.value_or(*id), std::move(world), dynamics, std::move(reward), std::move(members))};
}

Domain domain_or_error(DomainReading reading) {
  if (!reading.domain) throw Error{std::move(reading.diagnostics)};
  return *std::move(reading.domain);
}

}  // namespace

DomainReading parse_domain(std::string_view text, const std::string& name, const DomainLimits& limits) {
  TomlParsing parsing = parse_toml(text, name);
  if (!parsing.document) return {std::nullopt, std::move(parsing.diagnostics)};
  TomlReport report{*parsing.document};
  std::optional<Domain> domain = read_document(*parsing.document, limits, report);
  return {std::move(domain), report.diagnostics()};
}

DomainReading read_domain(const std::filesystem::path& path) {
  std::ifstream in{path, std::ios::binary};
  std::ostringstream text;
  if (in) text << in.rdbuf();
  if (!in || std::filesystem::is_directory(path)) {
    throw Error{ErrorKind::kIo, "cannot read the domain file " + path.string()};
  }
  return parse_domain(text.str(), path.string());
}

Domain load_domain(const std::string& name_or_path) {
  std::vector<std::string> names;
  for (const BuiltInDomain& built_in : built_in_domains()) {
    if (built_in.name == name_or_path) {
      return domain_or_error(parse_domain(built_in.text, std::string{built_in.name} + " (built in)"));
    }
    names.emplace_back(built_in.name);
  }
  if (std::filesystem::exists(name_or_path)) return domain_or_error(read_domain(name_or_path));
  Diagnostic unknown;
  unknown.id = "E0116";
  unknown.file = name_or_path;
  unknown.message = "there is no built-in domain and no file of this name";
  unknown.hint = suggestion(name_or_path, names);
  throw Error{{unknown}};
}

}  // namespace kith
