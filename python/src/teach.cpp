#include <algorithm>
#include <nlohmann/json.hpp>

#include "assignment.hpp"
#include "errors.hpp"
#include "kith/runs/run_folder.hpp"
#include "kith/study/transcript.hpp"
#include "kith/study/transcript_json.hpp"
#include "own_kinds.hpp"
#include "waiting.hpp"

namespace kith::python {
namespace {

py::tuple taught(const DomainPointer& domain, const Assignment& assignment) {
  const auto atlas = domain->atlas();
  const auto texts = wait_for([atlas, assignment] {
    const auto transcript = transcribe(*atlas, assignment.spec, assignment.address);
    return std::pair{transcript_json(*atlas, transcript).dump(), to_text(*atlas, transcript)};
  });
  return py::make_tuple(texts.first, texts.second);
}

py::tuple teach(const DomainPointer& domain, const std::string& group, const std::string& strategy, std::uint64_t seed,
                const std::string& study, const std::string& text, const std::vector<std::string>& overrides) {
  return taught(domain, assignment_of(domain->domain(), group, 0, strategy, seed, {study, text, overrides}));
}

py::tuple replay(const std::string& folder, std::size_t team) {
  const OwnKinds own;
  auto reading = read_run_folder(folder, own.kinds());
  if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
  const auto addresses = team_addresses(*reading.study);
  if (team < 1 || team > addresses.size())
    throw py::index_error{"the run has teams 1 to " + std::to_string(addresses.size())};
  const auto& address = addresses[team - 1];
  const auto domain =
      std::make_shared<LoadedDomain>(*std::move(reading.domain), reading.domain_text, reading.domain_files);
  return taught(domain, {reading.study->variants[address.variant], address});
}

}  // namespace

StudyReading read_study(const StudySource& source, const StudyKinds& kinds) {
  const StudyReadOptions options{
      .overrides = source.overrides, .folder = {}, .kinds = kinds, .override_name = "settings"};
  auto reading =
      source.text.empty() ? load_study(source.name, options) : parse_study(source.text, source.name, options);
  if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
  warn(reading.diagnostics);
  return reading;
}

Assignment assignment_of(const Domain& domain, std::string group, std::size_t members, const std::string& strategy,
                         std::uint64_t seed, const StudySource& study) {
  const OwnKinds own;
  auto spec = read_study(study, own.kinds()).study->variants.front();
  std::string letters;
  for (const auto& type : spec.learner_types) letters += type.letter;
  constexpr std::size_t kMaxTeamSize = 30;
  if (group.empty()) {
    if (members < 1 || members > kMaxTeamSize) throw py::value_error{"a team has 1 to 30 members"};
    group = std::string(members, letters.front());
  }
  if (const auto at = group.find_first_not_of(letters); at != std::string::npos)
    throw py::value_error{"the study has no learner type '" + group.substr(at, 1) + "', only " + letters};
  if (group.size() > kMaxTeamSize) throw py::value_error{"a group has at most 30 members"};
  const auto is_there = std::any_of(spec.strategies.begin(), spec.strategies.end(),
                                    [&](const auto& one) { return one.name == strategy; });
  if (!is_there) spec.strategies.push_back(strategy_named(strategy, own.strategies()));
  spec.seed = seed;
  spec.factors.clear();
  take_domain(spec, domain);
  return {std::move(spec), {0, strategy, std::move(group), 1, 1}};
}

void bind_teach(py::module_& module) {
  module.def("teach", &teach, py::arg("domain"), py::arg("group"), py::arg("strategy"), py::arg("seed"),
             py::arg("study"), py::arg("text"), py::arg("overrides"));
  module.def("replay", &replay, py::arg("folder"), py::arg("team"));
}

}  // namespace kith::python
