// kith infer: weights for a robot whose reward nobody wrote down.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "command.hpp"
#include "input.hpp"
#include "kith/bec/inference.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/policy_file.hpp"
#include "kith/domains/variation.hpp"
#include "kith/explain/json.hpp"
#include "kith/explain/words.hpp"
#include "kith/files/file_set.hpp"
#include "page.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

namespace fs = std::filesystem;

struct InferOptions {
  std::string domain;
  std::string policy;
  std::string out;   ///< Empty: nothing is written.
  bool all = false;  ///< No list is cut short.
  bool yes = false;  ///< Replace files that are there.
};

constexpr std::size_t kShownStates = 10;  // without --all

// A domain with the weights that were found, as text and as what it means.
struct Inferred {
  WeightInference inference;
  std::string text;
  Domain domain;
  std::vector<DomainFile> files;
};

std::string text_of_policy(const std::string& file) {
  if (file == "-") return read_input(file).text;
  std::error_code failure;
  std::ifstream stream{file, std::ios::binary};
  if (!stream || fs::is_directory(file, failure)) throw Error{ErrorKind::kIo, "cannot read the policy " + file};
  return {std::istreambuf_iterator<char>{stream}, {}};
}

Inferred infer(const InferOptions& options, const Console& console) {
  const WorkNotice notice{console, "looking for weights"};
  const auto input = read_named(options.domain);
  const DomainFiles files{.folder = input.folder, .known = input.files};
  const auto open = parse_unweighed_domain(input.text, input.name, files);
  if (!open.domain) throw Error{open.diagnostics};
  const auto reading = parse_policy(text_of_policy(options.policy), options.policy, *open.domain);
  if (!reading.policy) throw Error{reading.diagnostics};
  auto inference = infer_weights(*open.domain, *reading.policy);
  auto text = with_inferred_weights(input.text, open.domain->feature_names(), inference.weights, as_inferred(inference),
                                    inference.left_out);
  auto written = parse_domain(text, "the domain with inferred weights", {}, files);
  if (!written.domain) throw Error{written.diagnostics};
  console.show(written.diagnostics);
  return {std::move(inference), std::move(text), *std::move(written.domain), std::move(written.files)};
}

// What was found, for people.
class InferenceText {
 public:
  InferenceText(const Inferred& found, bool all, const Console& console)
      : domain_{found.domain}, inference_{found.inference}, all_{all}, console_{console} {}

  std::string text() {
    out_ = console_.bold(domain_.id()) + ": " + explained_in_words(domain_) + "\n";
    weights();
    sides();
    unexplained();
    clashes();
    return std::move(out_);
  }

 private:
  void heading(const std::string& text) { out_ += "\n" + console_.bold(text) + "\n"; }

  [[nodiscard]] std::string place(StartId id) const {
    return (domain_.num_mdps() > 1 ? world_text(domain_, id.mdp) + ": " : "") + domain_.state_name(id.mdp, id.start);
  }

  [[nodiscard]] std::size_t shown_of(std::size_t count) const { return all_ ? count : std::min(count, kShownStates); }

  void rest_of(std::size_t count) {
    if (count > shown_of(count)) out_ += fmt::format("  ... {} more: --all shows them\n", count - shown_of(count));
  }

  void weights() {
    heading(inference_.is_optimal ? "Weights under which all that it does is best" : "Weights that explain most");
    for (std::size_t k = 0; k < domain_.num_features(); ++k)
      out_ += fmt::format("  {:<16} {:>10}\n", domain_.feature_names()[k], inference_.weights[k]);
    out_ += fmt::format("  {} seen; margin {:.4f}; what is not explained gives away {:.4g} per action, at length 1\n",
                        counted(inference_.num_seen, "state"), inference_.margin, inference_.loss);
  }

  void sides() {
    heading("What follows, and in how many states the robot shows it");
    for (const auto& side : inference_.sides) {
      out_ += fmt::format("  {:>6}  {}\n", side.support == 0 ? "known" : std::to_string(side.support),
                          described(domain_, side.half_space));
    }
  }

  void unexplained() {
    if (inference_.unexplained.empty()) return;
    heading("Not explained");
    auto worst = inference_.unexplained;
    std::stable_sort(worst.begin(), worst.end(), [](const auto& a, const auto& b) { return a.loss > b.loss; });
    const auto& actions = domain_.action_names();
    for (std::size_t i = 0; i < shown_of(worst.size()); ++i) {
      const auto& one = worst[i];
      out_ += fmt::format("  {}: it does {}, {} would be best{}\n", place(one.state),
                          one.does ? actions[one.does->value()] : "nothing that changes the state",
                          actions[one.best.value()], one.does ? fmt::format(" by {:.4g}", one.loss) : "");
    }
    rest_of(worst.size());
  }

  void clashes() {
    if (inference_.clashes.empty()) return;
    heading("What a further feature would have to tell apart");
    for (const auto& clash : inference_.clashes) {
      out_ += "  " + joined(clash.states, "; ", [&](StartId state) { return place(state); }) + "\n";
      for (const auto& half_space : clash.half_spaces) out_ += "    " + described(domain_, half_space) + "\n";
    }
  }

  const Domain& domain_;
  const WeightInference& inference_;
  bool all_;
  const Console& console_;
  std::string out_;
};

Json id_json(StartId id) { return {{"world", id.mdp.value()}, {"start", id.start.value()}}; }

Json document_of(const Inferred& found) {
  const auto& domain = found.domain;
  const auto& inference = found.inference;
  const auto d = domain.num_features();
  Json weights;
  for (std::size_t k = 0; k < d; ++k) weights[domain.feature_names()[k]] = inference.weights[k];
  Json sides = Json::array();
  for (const auto& side : inference.sides)
    sides.push_back({{"half_space", to_json(side.half_space.normal())},
                     {"words", in_words(domain, side.half_space)},
                     {"states", side.support}});
  Json unexplained = Json::array();
  for (const auto& one : inference.unexplained) {
    auto json = id_json(one.state);
    json["name"] = domain.state_name(one.state.mdp, one.state.start);
    json["does"] = one.does ? Json(domain.action_names()[one.does->value()]) : Json{};
    json["best"] = domain.action_names()[one.best.value()];
    json["loss"] = one.loss;
    unexplained.push_back(std::move(json));
  }
  Json clashes = Json::array();
  for (const auto& clash : inference.clashes) {
    Json states = Json::array();
    for (const auto& state : clash.states) states.push_back(id_json(state));
    clashes.push_back({{"states", states}, {"half_spaces", to_json(clash.half_spaces, d)}});
  }
  Json left_out = Json::array();
  for (const auto& id : inference.left_out) left_out.push_back(id_json(id));
  return {{"schema", "kith.infer/1"},          {"id", domain.id()},        {"optimal", inference.is_optimal},
          {"share", inference.share},          {"loss", inference.loss},   {"margin", inference.margin},
          {"states_seen", inference.num_seen}, {"weights", weights},       {"region", sides},
          {"unexplained", unexplained},        {"to_tell_apart", clashes}, {"left_out", left_out}};
}

// With the files that it names, where these are not beside it yet.
void write_domain(const Inferred& found, const InferOptions& options, Console& console) {
  const fs::path out{options.out};
  const auto folder = out.has_parent_path() ? out.parent_path() : fs::path{"."};
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) refuse("there is no folder " + folder.string() + "; make it first");
  require_replaceable(out, options.yes);
  FileSet set{folder};
  set.write(out.filename().string(), found.text);
  std::vector<std::string> names{out.filename().string()};
  for (const auto& file : found.files) {
    std::ifstream there{folder / file.name, std::ios::binary};
    const bool is_same = there && std::string{std::istreambuf_iterator<char>{there}, {}} == file.text;
    if (is_same) continue;
    require_replaceable(folder / file.name, options.yes);
    fs::create_directories((folder / file.name).parent_path());
    set.write(file.name, file.text);
    names.push_back(file.name);
  }
  set.commit();
  for (const auto& name : names) console.info("wrote " + (folder / name).string());
}

void declare(OptionList& list, InferOptions& options) {
  list.domain(options.domain).required();
  list.text("--policy", options.policy, "FILE",
            "What the robot does: a table with the columns state and action, or JSON; '-' is standard input")
      .required();
  list.text("-o,--out", options.out, "FILE", "Domain file to write, with the weights and the files that it names");
  list.flag("--all", options.all, "Do not cut lists short");
  list.flag("--yes", options.yes, "Replace existing files");
  list.json();
}

int run(const InferOptions& options, Console& console) {
  const auto found = infer(options, console);
  if (!options.out.empty()) write_domain(found, options, console);
  console.print([&] { return document_of(found); }, [&] { return InferenceText{found, options.all, console}.text(); });
  return 0;
}

}  // namespace

void add_infer(Commands& commands) {
  commands.add<InferOptions>("infer", "Find the reward weights that explain what a robot does",
                             {"kith infer my-domain.toml --policy policy.csv -o explained.toml",
                              "kith infer item-delivery --policy paths.csv --all"},
                             declare, run);
}

}  // namespace kith::cli
