#pragma once

/// The names of columns that are read again after they were written: by analyses, reports and plans. A name that only
/// its own table needs stands in the line that declares the column.
namespace kith::columns {

// Of the tables of a study.
inline constexpr auto* kStrategy = "strategy";
inline constexpr auto* kComposition = "composition";
inline constexpr auto* kReplicate = "replicate";
inline constexpr auto* kTeam = "team";
inline constexpr auto* kSeedAddress = "seed_address";
inline constexpr auto* kStatus = "status";
inline constexpr auto* kCompleted = "completed";
inline constexpr auto* kPeriods = "periods";
inline constexpr auto* kDemonstrations = "demonstrations";
inline constexpr auto* kTests = "tests";
inline constexpr auto* kKnowledge = "knowledge";
inline constexpr auto* kAreaSr = "area_sr";
inline constexpr auto* kMinutes = "minutes";
inline constexpr auto* kPersonMinutes = "person_minutes";
inline constexpr auto* kForecastPeriods = "forecast_periods";
inline constexpr auto* kForecastPeriodsLow = "forecast_periods_low";
inline constexpr auto* kForecastPeriodsHigh = "forecast_periods_high";
inline constexpr auto* kFewestParticles = "fewest_particles";
inline constexpr auto* kExamShareRight = "exam_share_right";
inline constexpr auto* kExamRegret = "exam_regret";
inline constexpr auto* kExamWorstShareRight = "exam_worst_share_right";
inline constexpr auto* kPeriod = "period";
inline constexpr auto* kComponent = "kc";
inline constexpr auto* kMember = "member";
inline constexpr auto* kMembers = "members";
inline constexpr auto* kType = "type";
inline constexpr auto* kTest = "test";
inline constexpr auto* kMdp = "mdp";
inline constexpr auto* kStart = "start";
inline constexpr auto* kCorrect = "correct";
inline constexpr auto* kRegret = "regret";
inline constexpr auto* kShareRight = "share_right";
inline constexpr auto* kAnswer = "answer";
inline constexpr auto* kConstraint = "constraint";
inline constexpr auto* kCovered = "covered";
inline constexpr auto* kBelief = "p_bec";
inline constexpr const char* kForecastDone[] = {"forecast_done_1", "forecast_done_2", "forecast_done_3"};
inline constexpr auto* kPredictedMastery = "p_mastery";
inline constexpr auto* kMastery = "mastery";
inline constexpr auto* kAbility = "ability";
inline constexpr auto* kAbilityMean = "ability_mean";
inline constexpr auto* kAbilityLow = "ability_low";
inline constexpr auto* kAbilityHigh = "ability_high";
inline constexpr auto* kProficiency = "proficiency";

// Of the tables of live sessions, which have some of the above too.
inline constexpr auto* kSession = "session";
inline constexpr auto* kSeat = "seat";
inline constexpr auto* kPeople = "people";
inline constexpr auto* kStartedMs = "started_ms";
inline constexpr auto* kEnded = "ended";
inline constexpr auto* kSimulated = "simulated";
inline constexpr auto* kRight = "right";
inline constexpr auto* kTaughtComponent = "component";
inline constexpr auto* kActive = "n_active";

}  // namespace kith::columns
