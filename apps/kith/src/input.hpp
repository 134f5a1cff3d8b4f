#pragma once

#include <filesystem>
#include <string>

#include "console.hpp"
#include "kith/bec/atlas.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/study/study_file.hpp"

namespace kith::cli {

/// A text that the user named.
struct InputText {
  std::string name;  ///< For messages.
  std::string text;
  std::filesystem::path folder;        ///< Where files that it names are looked for.
  std::vector<DomainFile> files = {};  ///< Those that come with kith.
};

/// The file's text, or that of standard input for "-". At most a little more than
/// a domain or study file may have is read. @throws kith::Error (kIo).
[[nodiscard]] InputText read_input(const std::string& file);

/// The same, or the text of the domain or study of this name that comes with kith.
[[nodiscard]] InputText read_named(const std::string& name_or_file);

/// The study of a built-in name, a file or "-", with its overrides; warnings are
/// returned, errors thrown.
[[nodiscard]] StudyReading study_of(const std::string& name, const std::vector<std::string>& overrides);

/// Shows what there is to say about a study file, and names what `kith validate` says about its domain.
void show_warnings(const StudyReading& reading, Console& console);

/// What people believe of a robot who knew it before an update: the region of the older domain, a built-in name or a
/// file, within the prior of the newer one. @throws UsageError if the domains have other features, or nobody can know
/// both; kith::Error as load_domain().
[[nodiscard]] Cone known_before(const std::string& older, const Atlas& newer);

/// The MDP of this number or name. @throws UsageError if there is none; it lists the names.
[[nodiscard]] MdpIndex mdp_called(const Domain& domain, const std::string& number_or_name);

}  // namespace kith::cli
