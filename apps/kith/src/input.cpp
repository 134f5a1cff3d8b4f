#include "input.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fmt/format.h>

#include "command.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/core/error.hpp"
#include "kith/core/text.hpp"
#include "kith/domains/other_models.hpp"
#include "kith/files/document.hpp"
#include "kith/files/file.hpp"
#include "kith/teaching/older_robot.hpp"

namespace kith::cli {
namespace {

// Up to so many bytes of standard input. Not by std::cin, which takes an error for the end.
std::string standard_input(std::size_t most) {
  std::string text;
  std::array<char, 64 * 1024> piece;
  while (text.size() < most) {
    const auto count = ::read(STDIN_FILENO, piece.data(), std::min(piece.size(), most - text.size()));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      throw Error{ErrorKind::kIo, std::string{"cannot read standard input: "} + std::generic_category().message(errno)};
    if (count == 0) break;
    text.append(piece.data(), static_cast<std::size_t>(count));
  }
  return text;
}

}  // namespace

InputText read_input(const std::string& file) {
  if (file == "-") return {"<stdin>", standard_input(kMaxTomlBytes + 1), {}};
  refuse_models_of_others(file);
  const auto text = read_toml_text(file);
  if (!text) throw Error{ErrorKind::kIo, "cannot read " + file + ": " + why_unreadable(file)};
  return {file, *text, std::filesystem::path{file}.parent_path()};
}

InputText read_named(const std::string& name_or_file) {
  for (const auto& domain : built_in_domains()) {
    if (domain.name == name_or_file) return {name_or_file, std::string{domain.text}, {}, domain.files};
  }
  for (const auto& study : built_in_studies()) {
    if (study.name == name_or_file) return {name_or_file, std::string{study.text}, {}};
  }
  return read_input(name_or_file);
}

StudyReading study_of(const std::string& name, const std::vector<std::string>& overrides) {
  auto reading = [&] {
    const StudyReadOptions options{.overrides = overrides, .override_name = "--set"};
    if (name != "-") return load_study(name, options);
    const auto input = read_input(name);
    return parse_study(input.text, input.name, options);
  }();
  if (!reading.study) throw Error{reading.diagnostics};
  return reading;
}

void show_warnings(const StudyReading& reading, Console& console) {
  std::vector<Diagnostic> shown;
  std::vector<std::string> of_domain;
  std::string file;
  for (const auto& diagnostic : reading.diagnostics) {
    const bool is_of_domain = diagnostic.severity == Severity::kWarning &&
                              (diagnostic.id.starts_with("W02") || diagnostic.id.starts_with("W03"));
    if (!is_of_domain) {
      shown.push_back(diagnostic);
    } else if (std::find(of_domain.begin(), of_domain.end(), diagnostic.id) == of_domain.end()) {
      of_domain.push_back(diagnostic.id);
      file = diagnostic.file;
    }
  }
  console.show(shown);
  if (!of_domain.empty()) console.info(fmt::format("about the domain: {} (kith validate {})", listed(of_domain), file));
}

Cone known_before(const std::string& older, const Atlas& newer) {
  auto domain = load_domain(older);
  if (const auto why = why_incomparable(domain, newer.domain()); !why.empty())
    refuse("--knowing " + older + ": " + why, "name a domain file with the same features in the same order");
  require_teaching_memory(domain);
  const auto robot = older_robot(Atlas{std::move(domain)});
  if (const auto known = known_within(newer.prior_cone(), robot.region)) return *known;
  refuse("--knowing " + older + ": no weights satisfy what people knew and the prior of " + newer.domain().id(),
         "leave out of the prior what did not hold before the update");
}

MdpIndex mdp_called(const Domain& domain, const std::string& number_or_name) {
  if (const auto found = domain.find_world(number_or_name)) return *found;
  constexpr std::size_t kMost = 12;
  std::vector<std::string> names;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    if (!domain.world_name(m).empty()) names.push_back(domain.world_name(m));
  }
  const bool is_number = number_or_name.find_first_not_of("0123456789") == std::string::npos;
  const auto shown = is_number ? number_or_name : "'" + number_or_name + "'";
  auto message = fmt::format("there is no world {}: they are numbered 0 to {}", shown, domain.num_mdps() - 1);
  if (!names.empty() && names.size() <= kMost) message += ", or called " + listed(names);
  refuse(message);
}

}  // namespace kith::cli
