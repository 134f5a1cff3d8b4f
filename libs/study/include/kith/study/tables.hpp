#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kith/files/codebook.hpp"
#include "kith/study/records.hpp"
#include "kith/study/study.hpp"

namespace kith {

/// Takes the next piece of the file of that name ("teams.csv").
using TableSink = std::function<void(std::string_view file, std::string_view piece)>;

/// Writes teams, learners, periods, responses, demonstrations and progress.csv,
/// and particles.csv if the study records particles, team by team in the given
/// order, in pieces that end where rows do. Each file gets at least its header.
/// The study's varied keys are columns right behind the composition. The
/// bytes depend on the study and its teams only.
void write_study_tables(const Study& study, std::span<const TeamRecord> teams, const TableSink& sink);

/// Hands every team of a run to what it is given, in the order of their numbers.
using TeamSource = std::function<void(const std::function<void(const TeamRecord& team)>& visit)>;
/// The same for teams that come one by one; none is kept.
void write_study_tables(const Study& study, const TeamSource& teams, const TableSink& sink);

/// The tables of a run of the study, in the order in which they are written: the one place where columns are defined.
[[nodiscard]] std::vector<TableDescription> study_tables(const Study& study);

/// The document that describes every column of these tables (codebook.json).
/// @param run  the digest of what the study was asked (RunInputs::digest()), so that tables on their own tell it.
[[nodiscard]] std::string study_codebook(const Study& study, const std::string& run);

}  // namespace kith
