#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kith/bec/atlas.hpp"
#include "kith/explain/json.hpp"
#include "kith/explain/update.hpp"
#include "kith/study/study.hpp"
#include "kith/teaching/forecast.hpp"

namespace kith {

/// Texts of pages in one language.
struct LiveLanguage {
  std::string code = "en";                       ///< Of BCP 47, for the attribute lang.
  std::string direction = "ltr";                 ///< Or "rtl".
  std::map<std::string, std::string> strings{};  ///< By key; keys that are missing are English.
  friend bool operator==(const LiveLanguage&, const LiveLanguage&) = default;
};

/// All that the rooms of a study share. Immutable; one for the whole server.
struct LiveStudy {
  StudySpec spec;  ///< With `group`: its texts filled in, its files read.
  std::shared_ptr<const Atlas> atlas;
  std::string domain_text;  ///< The domain file, of which people may change the map; see Explored.
  LiveLanguage language;
  StartIndex sandbox;  ///< Where people try the keyboard: at least two steps from the end if possible, then
                       ///< a start that tests nothing.
  std::vector<StartIndex> screening;      ///< The tests of `group.screening`.
  std::optional<UpdateInWords> update{};  ///< For people who know the robot as it was before an update.
  std::string key;                        ///< Identifies the domain in keys of worlds: 8 hexadecimal digits.
  std::shared_ptr<const Json> legend;     ///< What every board says of the domain: nothing about rewards.
  /// Imagined sessions by strategy and composition, for forecasts; empty unless StudySpec::forecast_sessions.
  std::map<std::pair<std::string, std::string>, std::vector<PastSession>> imagined;

  [[nodiscard]] const GroupOptions& group() const noexcept { return spec.group; }
  /// Whether people are screened on a waiting list before it is decided who sits with whom.
  [[nodiscard]] bool seats_by_ability() const noexcept { return !screening.empty() && !group().high_types.empty(); }
};

/// What rooms of this study share. Tests of the screening are drawn from the study's seed. People are never asked about
/// starts without an answerable_path(): the atlas of the result has no tests there.
/// @param folder  where consent_file and language are looked for.
/// @param domain_text  the domain file, see LiveStudy::domain_text; empty: nobody can change its map.
/// @throws kith::Error (kInvalidInput) if the study varies keys, a strategy needs the truth about learners, the study
/// releases members or teaches types apart, its only strategy teaches one person and no composition has one, no group
/// has a place for people of high or of low ability although the screening seats them, or consent_file or language
/// cannot be understood; (kInfeasible) if a world has more than kMaxLiveStates states or the domain cannot be taught or
/// asked about; (kIo) if a file cannot be read.
[[nodiscard]] std::shared_ptr<const LiveStudy> make_live_study(const Study& study, std::shared_ptr<const Atlas> atlas,
                                                               const std::filesystem::path& folder = {},
                                                               std::string domain_text = {});

/// What people would miss or wonder about: files of texts that are not there (W1601), and places that a template left
/// to its author (W1602).
/// @param folder  as of make_live_study().
[[nodiscard]] std::vector<Diagnostic> warnings_for_people(const StudySpec& spec,
                                                          const std::filesystem::path& folder = {});

/// The cells of the design that rooms are made for in turn: strategies within compositions, without those that cannot
/// be taught together (the baseline teaches one person).
struct LiveCell {
  std::string strategy;
  std::string composition;  ///< Filled up to GroupOptions::size.
  friend bool operator==(const LiveCell&, const LiveCell&) = default;
};
[[nodiscard]] std::vector<LiveCell> live_cells(const LiveStudy& study);

/// {id, title, domain, strategies: [{name, description}], types: [{letter, label}], compositions, size, dropout,
/// grace_s, stores, time}: what the facilitator's page says about the study. `compositions` are those of live_cells(),
/// `size` is the number of seats of the largest.
[[nodiscard]] Json live_study_json(const LiveStudy& study);

/// What a session keeps of people beside their answers, for pages that say so: {names, text, questions, screening,
/// discussion}, whether there are any, and query, the parameters of links that are collected.
[[nodiscard]] Json stored_json(const GroupOptions& group);

/// {lang, dir, strings}: texts of pages that differ from the built-in English ones.
[[nodiscard]] Json language_json(const LiveStudy& study);

/// Of the query parameters of a link, those that the study collects: texts without control characters, at most 200
/// bytes. Others are dropped, so they are never stored. @param query  an object; anything else gives none.
[[nodiscard]] Json collected_query(const LiveStudy& study, const Json& query);

/// The page of somebody for whom there was no seat: a ParticipantView in the stage `full`.
/// @param code  a completion code, empty: none. @param query  see collected_query(); for the redirect.
[[nodiscard]] Json full_view(const LiveStudy& study, const std::string& code, const Json& query, std::int64_t now_us);

/// A completion code: the study's prefix, a hyphen and 10 letters and digits from a hash of the arguments.
/// @param salt  a secret of the server, so that codes cannot be guessed.
[[nodiscard]] std::string completion_code(const LiveStudy& study, std::string_view salt, std::string_view room,
                                          std::size_t seat);

}  // namespace kith
