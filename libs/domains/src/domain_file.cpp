#include "kith/domains/domain_file.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <type_traits>
#include <utility>

#include "domain_data.hpp"
#include "dynamics.hpp"
#include "family.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/other_models.hpp"
#include "kith/files/document.hpp"
#include "kith/files/file.hpp"
#include "kith/files/reader.hpp"
#include "read_model.hpp"
#include "reward.hpp"

namespace kith {
namespace {

using detail::RewardOf;

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
void check_has_goal(const detail::FamilyMap& family_map, const detail::Dynamics& dynamics, TomlReport& report) {
  const auto& actions = dynamics.actions;
  if (family_map.some_goal || std::find(actions.begin(), actions.end(), detail::Action::kExit) != actions.end()) return;
  report.error("E0210", family_map.map_place, "the map has no goal",
               "declare a symbol with goal = true or destination = \"ITEM\", or the action \"exit\"");
}

// Warns of features that cannot be taught.
template <typename Member>
void check_features(const detail::Dynamics& dynamics, const std::vector<Member>& members, TomlReport& report) {
  if (dynamics.features.size() < 2) {
    report.warning("W0304", dynamics.features.back().place,
                   "a single feature: planning and inspection work, teaching does not",
                   "a policy shows how features are weighed against each other: count something else too");
  }
  for (std::size_t k = 0; k < dynamics.features.size(); ++k) {
    if (dynamics.features[k].when.names_absent_things) continue;
    if (std::ranges::any_of(members, [k](const Member& member) { return member.mdp.has_feature(k); })) continue;
    report.warning("W0301", dynamics.features[k].place,
                   "feature '" + dynamics.features[k].name + "' occurs in no " +
                       (std::is_same_v<Member, ExplicitMember> ? "MDP" : "world"));
  }
}

// What both kinds of domains have.
Domain::Data data_from(const detail::Dynamics& dynamics, detail::Reward reward) {
  Domain::Data data;
  data.feature_names = dynamics.feature_names();
  data.wordings = std::move(reward.words);
  data.weights = std::move(reward.weights);
  data.prior = std::move(reward.prior);
  data.max_steps = dynamics.max_steps;
  return data;
}

GridFamily grid_from(detail::FamilyMap family_map, std::vector<DomainMember> members) {
  GridFamily grid;
  for (const detail::Item& item : family_map.items) grid.item_names.push_back(item.name);
  grid.layout = detail::StateLayout{family_map};
  grid.family_map = std::move(family_map);
  grid.members = std::move(members);
  grid.describe_states();
  return grid;
}

std::optional<Domain::Data> read_grid(TomlReader& file, const DomainLimits& limits, detail::NamedFiles& files,
                                      detail::ModelReport& model_report, RewardOf reward_of) {
  TomlReport& report = file.report();
  detail::FamilyMap family_map = detail::read_world(file, files, model_report);
  const detail::Dynamics dynamics = detail::read_dynamics(file, family_map);
  detail::Reward reward = detail::read_reward(file, dynamics, reward_of);
  file.finish();
  if (family_map.is_sound) check_has_goal(family_map, dynamics, report);
  if (report.has_errors() || model_report.has_errors()) return std::nullopt;

  std::vector<DomainMember> members = detail::build_family(family_map, dynamics, limits, report);
  if (report.has_errors()) return std::nullopt;
  if (reward_of == RewardOf::kFile) detail::check_optimum(family_map, dynamics, reward, members, report);
  if (report.has_errors()) return std::nullopt;
  check_features(dynamics, members, report);
  Domain::Data data = data_from(dynamics, std::move(reward));
  for (const detail::Action action : dynamics.actions) {
    data.action_names.push_back(detail::all_action_names()[static_cast<std::size_t>(action)]);
  }
  for (const detail::Feature& feature : dynamics.features) {
    data.feature_things.push_back(detail::things_of(feature.when, dynamics.atoms, family_map));
  }
  data.family = grid_from(std::move(family_map), std::move(members));
  return data;
}

std::optional<Domain::Data> read_explicit(TomlReader& file, const DomainLimits& limits, detail::NamedFiles& files,
                                          detail::ModelReport& model_report, RewardOf reward_of) {
  TomlReport& report = file.report();
  detail::ModelReading model = detail::read_model(file, files, model_report);
  const auto failed = [&] { return report.has_errors() || model_report.has_errors(); };
  if (failed()) {  // the rest speaks of features
    for (const char* key : {"reward", "prior", "words"}) file.know(key);
    file.finish();
    return std::nullopt;
  }
  detail::Reward reward = detail::read_reward(file, model.dynamics, reward_of);
  file.finish();
  if (failed()) return std::nullopt;

  const auto weights_place = reward.weights_place;
  Domain::Data data = data_from(model.dynamics, std::move(reward));
  data.action_names = model.model.actions.all();
  ExplicitFamily family = detail::build_explicit_family(std::move(model.model), data.feature_names.size(),
                                                        model.dynamics.discount, limits, model_report);
  if (failed()) return std::nullopt;
  if (reward_of == RewardOf::kFile) detail::check_model(family, data, model.dynamics, weights_place, report);
  if (failed()) return std::nullopt;
  check_features(model.dynamics, family.members, report);
  if (model.drawing) family.drawing = detail::draw_model(*std::move(model.drawing), family, report);
  data.family = std::move(family);
  return data;
}

// [inferred]: how well weights explain a robot, and the starts that they leave out.
class InferredTable {
 public:
  void read(TomlReader& file) {
    auto table = file.table("inferred", Presence::kOptional);
    if (!table) return;
    place_ = table->place();
    InferredWeights read;
    constexpr RealRange kShare{0.0, 1.0, true, false}, kSize{0.0};
    read.share = table->real("share", Presence::kRequired, kShare).value_or(1.0);
    read.loss = table->real("loss", Presence::kOptional, kSize).value_or(0.0);
    read.margin = table->real("margin", Presence::kOptional, kSize).value_or(0.0);
    left_out_ = states_of(*table, "left_out", file.report());
    not_explained_ = states_of(*table, "not_explained", file.report());
    table->finish();
    inferred_ = std::move(read);
  }

  void apply(Domain::Data& data, TomlReport& report) {
    if (!inferred_) return;
    std::visit(
        [&](auto& family) {
          know_states(family.members, report);
          remove_starts(family.members, report);
        },
        data.family);
    inferred_->left_out = num_removed_;
    data.inferred = std::move(inferred_);
  }

 private:
  struct StatesOfWorld {
    std::size_t world;
    std::vector<StateIndex> states;
    TomlPlace place;
  };
  using Lists = std::vector<StatesOfWorld>;

  static constexpr const char* kHint =
      "'kith infer' writes this table; run it again if the map or the model has changed";

  static Lists states_of(TomlReader& table, const std::string& key, TomlReport& report) {
    Lists lists;
    const TomlArray* array = table.array(key, Presence::kOptional);
    if (array == nullptr) return lists;
    for (const TomlValue& element : *array) {
      const TomlArray* list = read_array(element, "a world and states of it", report);
      if (list == nullptr) continue;
      std::vector<std::size_t> numbers;
      for (const TomlValue& one : *list) {
        if (const auto number = read_integer(one, "a number of '" + key + "'", {0, 0xFFFFFFFF}, report))
          numbers.push_back(static_cast<std::size_t>(*number));
      }
      if (numbers.empty()) continue;
      StatesOfWorld of_world{numbers.front(), {}, element.place()};
      for (std::size_t i = 1; i < numbers.size(); ++i) of_world.states.emplace_back(numbers[i]);
      lists.push_back(std::move(of_world));
    }
    return lists;
  }

  template <typename Member>
  static bool is_world(const StatesOfWorld& list, const std::vector<Member>& members, TomlReport& report) {
    if (list.world < members.size()) return true;
    report.error("E0318", list.place, "there is no world " + std::to_string(list.world), kHint);
    return false;
  }

  template <typename Member>
  void know_states(const std::vector<Member>& members, TomlReport& report) {
    for (const StatesOfWorld& list : not_explained_) {
      if (!is_world(list, members, report)) return;
      for (const StateIndex s : list.states) {
        if (s.value() >= members[list.world].mdp.num_states()) {
          return report.error("E0318", list.place,
                              "the robot does nothing in state " + std::to_string(s.value()) + " of world " +
                                  std::to_string(list.world),
                              kHint);
        }
        inferred_->not_explained.push_back({MdpIndex{list.world}, s});
      }
    }
    std::ranges::sort(inferred_->not_explained);
  }

  template <typename Member>
  void remove_starts(std::vector<Member>& members, TomlReport& report) {
    for (const StatesOfWorld& list : left_out_) {
      if (!is_world(list, members, report)) return;
      auto& starts = members[list.world].starts;
      for (const StateIndex start : list.states) {
        const auto at = std::lower_bound(starts.begin(), starts.end(), start);
        if (at == starts.end() || *at != start) {
          return report.error(
              "E0318", list.place,
              "nothing can start in state " + std::to_string(start.value()) + " of world " + std::to_string(list.world),
              kHint);
        }
        starts.erase(at);
        ++num_removed_;
      }
    }
    const bool some =
        std::any_of(members.begin(), members.end(), [](const Member& one) { return !one.starts.empty(); });
    if (!some) report.infeasible("E0319", place_, "no start is left that the weights explain", kHint);
  }

  TomlPlace place_;
  std::optional<InferredWeights> inferred_;
  Lists left_out_, not_explained_;
  std::size_t num_removed_ = 0;
};

std::optional<Domain> read_document(const TomlDocument& document, const DomainLimits& limits, const DomainFiles& files,
                                    RewardOf reward_of, TomlReport& report, detail::ModelReport& model_report,
                                    DomainReading& reading) {
  TomlReader file{document.root, {0, 1, 1, 1}, "the file", report};
  if (!check_schema(file)) return std::nullopt;
  const auto id = file.string("id", Presence::kRequired);
  if (id) check_id(file, *id);
  const auto title = file.string("title", Presence::kOptional);
  const auto goal = file.string("goal", Presence::kOptional);
  const TomlEntry* model = document.root.find_entry("model");
  const bool is_drawn = model != nullptr && model->value.table() != nullptr && model->value.table()->find("drawing");
  if (model != nullptr && !is_drawn && document.root.find("map") != nullptr) {
    report.error(
        "E0230", model->place, "a domain has a map or a model, not both",
        "remove one of them; if the map is a picture of the model, [model.drawing] says where the robot is on it");
    return std::nullopt;
  }
  detail::NamedFiles named{files, report};
  InferredTable inferred;
  if (reward_of == RewardOf::kFile) {
    inferred.read(file);
  } else {
    file.know("inferred");
  }
  auto data = model == nullptr ? read_grid(file, limits, named, model_report, reward_of)
                               : read_explicit(file, limits, named, model_report, reward_of);
  reading.files = named.take_read();
  if (!data || report.has_errors()) return std::nullopt;
  inferred.apply(*data, report);
  if (report.has_errors()) return std::nullopt;
  data->id = *id;
  data->title = title.value_or(*id);
  data->goal = goal.value_or("");
  data->sum_up();
  return Domain{*std::move(data)};
}

Domain domain_or_error(DomainReading reading) {
  if (!reading.domain) throw Error{std::move(reading.diagnostics)};
  return *std::move(reading.domain);
}

}  // namespace

namespace {

DomainReading parse(std::string_view text, const std::string& name, const DomainLimits& limits,
                    const DomainFiles& files, RewardOf reward) {
  TomlParsing parsing = parse_toml(text, name);
  if (!parsing.document) return {std::nullopt, std::move(parsing.diagnostics), {}};
  TomlReport report{*parsing.document};
  detail::ModelReport model_report;
  DomainReading reading;
  reading.domain = read_document(*parsing.document, limits, files, reward, report, model_report, reading);
  reading.diagnostics = report.diagnostics();
  for (Diagnostic diagnostic : model_report.diagnostics()) {
    if (diagnostic.file.empty()) diagnostic.file = name;
    reading.diagnostics.push_back(std::move(diagnostic));
  }
  return reading;
}

}  // namespace

DomainReading parse_domain(std::string_view text, const std::string& name, const DomainLimits& limits,
                           const DomainFiles& files) {
  return parse(text, name, limits, files, RewardOf::kFile);
}

DomainReading parse_unweighed_domain(std::string_view text, const std::string& name, const DomainFiles& files) {
  return parse(text, name, {}, files, RewardOf::kNobody);
}

void refuse_models_of_others(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 6> kEndings{".json", ".tra", ".sta", ".lab", ".srew", ".trew"};
  if (std::ranges::find(kEndings, path.extension().string()) == kEndings.end()) return;
  throw Error{{Diagnostic{.id = "E0236",
                          .message = "models of PRISM and Gymnasium are converted to a domain first",
                          .file = path.string(),
                          .hint = "python -m kith.convert " + path.string() + " -o DOMAIN.toml"}}};
}

DomainReading read_domain(const std::filesystem::path& path) {
  refuse_models_of_others(path);
  const auto text = read_toml_text(path);
  if (!text) throw Error{ErrorKind::kIo, "cannot read the domain file " + path.string() + ": " + why_unreadable(path)};
  return parse_domain(*text, path.string(), {}, {.folder = path.parent_path()});
}

Domain load_domain(const std::string& name_or_path) {
  std::vector<std::string> names;
  for (const BuiltInDomain& built_in : built_in_domains()) {
    if (built_in.name == name_or_path) {
      return domain_or_error(
          parse_domain(built_in.text, std::string{built_in.name} + " (built in)", {}, {.known = built_in.files}));
    }
    names.emplace_back(built_in.name);
  }
  std::error_code failure;
  if (std::filesystem::exists(name_or_path, failure)) return domain_or_error(read_domain(name_or_path));
  if (failure) throw Error{ErrorKind::kIo, "cannot read " + name_or_path + ": " + failure.message()};
  Diagnostic unknown;
  unknown.id = "E0116";
  unknown.file = name_or_path;
  unknown.message = "there is no built-in domain and no file of this name";
  const bool is_beside = std::filesystem::exists(name_or_path + ".toml", failure);
  unknown.hint = is_beside ? "did you mean " + name_or_path + ".toml?" : suggestion(name_or_path, names);
  throw Error{{unknown}};
}

}  // namespace kith
