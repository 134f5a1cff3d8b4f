#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/core/diagnostic.hpp"
#include "kith/domains/domain.hpp"
#include "kith/domains/domain_files.hpp"

namespace kith {

/// What came of reading a domain file: a domain unless there are errors, and
/// everything worth saying about the file, in file order.
struct DomainReading {
  std::optional<Domain> domain;
  std::vector<Diagnostic> diagnostics;
  std::vector<DomainFile> files;  ///< Those that the domain file names, as far as they could be read.
};

/// How large a domain may become before it is refused (E0219). A small file can describe a large one.
struct DomainLimits {
  std::size_t max_states = 2'000'000;  ///< Of all MDPs together; about 250 bytes each.
};

/// Parses and checks a domain file (schema kith.domain/1, see docs/domain-files.md).
/// All errors of a file are reported at once (at most 20); `name` is used in
/// messages. The files of an explicit model are read too. Never throws for bad content.
[[nodiscard]] DomainReading parse_domain(std::string_view text, const std::string& name,
                                         const DomainLimits& limits = {}, const DomainFiles& files = {});

/// The same for a robot whose weights are yet to be inferred: [reward] and [inferred] are not read, and
/// Domain::weights() is empty, so that nothing can be planned for it.
[[nodiscard]] DomainReading parse_unweighed_domain(std::string_view text, const std::string& name,
                                                   const DomainFiles& files = {});

/// Reads the file, and those that it names, and parses them. @throws kith::Error (kIo) if it cannot be read.
[[nodiscard]] DomainReading read_domain(const std::filesystem::path& path);

/// A domain that comes with kith.
struct BuiltInDomain {
  std::string_view name;  ///< "item-delivery"
  std::string_view description;
  std::string_view text;               ///< The TOML file, embedded when kith was built.
  std::vector<DomainFile> files = {};  ///< Those that it names.
};
[[nodiscard]] const std::vector<BuiltInDomain>& built_in_domains();

/// A built-in by name, or the domain file at that path.
/// @throws kith::Error with diagnostics if it is invalid, unknown (names the known ones) or unreadable.
[[nodiscard]] Domain load_domain(const std::string& name_or_path);

}  // namespace kith
