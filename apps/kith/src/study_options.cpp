// The options of commands that run, plan, look after and analyse studies.
#include "declare_options.hpp"
#include "option_values.hpp"

namespace kith::cli {
namespace {

void add_study(CLI::App& app, Options& options) {
  auto& study = options.study;
  auto& command = *app.add_subcommand("study", "Simulate all teams of a study and write its tables");
  add_study_name(command, study.study).required();
  command.add_option("-o,--out", study.out, "Run folder to create or to update")->type_name("DIR");
  add_threads(command, study.threads);
  takes_integer(*command.add_option("--seed", study.seed, "The same as --set seed=N"), 0);
  add_set(command, study.set);
  command.add_flag("--dry-run", study.dry_run, "Print what would be run and about how long it takes; write nothing");
  command.add_flag("--yes", study.yes, "Replace the results of a different study in the run folder");
  add_mode<ResumeMode>(command, "--resume", study.resume, "Whether to resume an earlier run", "WHEN",
                       {{"auto", ResumeMode::kAuto}, {"never", ResumeMode::kNever}, {"require", ResumeMode::kRequire}});
  add_shard(command, study.shard);
  auto* keep_going =
      command.add_flag("--keep-going", study.keep_going, "Continue after a team fails; exit 6 at the end");
  command.add_flag("--fail-fast")->description("Stop at the first team that fails (the default)")->excludes(keep_going);
  add_progress(command, study.progress);
  add_common(command, options.common);
}

void add_analyze(CLI::App& app, Options& options) {
  auto& analyze = options.analyze;
  auto& command = *app.add_subcommand("analyze", "Analyse the results of a study, or test a model on any table");
  command.add_option("input", analyze.input, "Run folder, CSV file, or '-' for standard input")
      ->required()
      ->type_name("DIR|CSV");
  auto* model =
      command.add_option("--model", analyze.model, "Response and factors, such as 'knowledge ~ strategy*composition'")
          ->type_name("FORMULA");
  takes_word(*command.add_option("--table", analyze.table, "Table of the run folder to which the model applies")
                  ->capture_default_str()
                  ->needs(model),
             "NAME", {"teams", "learners", "periods", "responses", "demonstrations", "progress"});
  command.add_option("--where", analyze.where, "Rows to keep, COLUMN=VALUE or COLUMN!=VALUE (may be repeated)")
      ->allow_extra_args(false)
      ->type_name("CONDITION");
  command.add_option("--observed", analyze.observed, "Column that is false where a count is censored")
      ->type_name("COLUMN")
      ->needs(model);
  command
      .add_option("--identifier", analyze.identifiers,
                  "Column that names who or what a row is about; rows with the same value belong together (may be "
                  "repeated)")
      ->allow_extra_args(false)
      ->type_name("COLUMN")
      ->needs(model);
  command.add_flag("--independent", analyze.independent, "Analyse rows as independent although identifiers repeat")
      ->needs(model);
  auto* counts = command.add_flag("--count", analyze.counts, "The response is a count of events")->needs(model);
  command.add_flag("--ordinal", analyze.ordinal, "The response is a rating, of which only the order counts")
      ->needs(model)
      ->excludes(counts);
  command
      .add_option("--codebook", analyze.codebook,
                  "Description of the columns (default: codebook.json beside the table)")
      ->type_name("FILE")
      ->needs(model);
  command
      .add_option(
          "--contrast", analyze.contrasts,
          "Planned comparison of means, such as 'team beliefs: joint + common - individual-low - individual-high' "
          "(may be repeated)")
      ->allow_extra_args(false)
      ->type_name("CONTRAST");
  command
      .add_option("--by", analyze.by, "Compare the levels of other factors at each level of this one (may be repeated)")
      ->allow_extra_args(false)
      ->type_name("FACTOR");
  command
      .add_option(
          "--smallest-effect", analyze.smallest_effect,
          "Smallest difference that matters, in units of the response or as d=0.3: tests whether differences are "
          "smaller")
      ->type_name("X");
  command.add_option("--latex", analyze.latex, "Write all findings and tables to this file as LaTeX")
      ->type_name("FILE");
  command.add_option("--csv", analyze.csv, "Write every table to this folder as CSV")->type_name("DIR");
  command.add_option("--r", analyze.r, "Write data, codebook and an R script that repeats the analysis to this folder")
      ->type_name("DIR")
      ->needs(model);
  command.add_flag("--brief", analyze.brief, "Findings in words only, without tables");
  // Far below 10^-6 and as near to 1 there are no quantiles any more.
  takes_number(*command.add_option("--alpha", analyze.alpha, "Significance level; intervals use 1 - alpha")
                    ->capture_default_str(),
               {1e-6, 1.0 - 1e-6}, "P");
  takes_word(*command
                  .add_option("--correct", analyze.correction,
                              "Correction for families of tests: compositions, planned contrasts")
                  ->capture_default_str(),
             "HOW", {"bonferroni", "holm", "fdr", "none"});
  takes_integer(*command.add_option("--permutations", analyze.permutations, "Permutations of permutation tests")
                     ->capture_default_str(),
                99, 1'000'000);
  takes_integer(*command.add_option("--seed", analyze.seed, "Seed of permutations")->capture_default_str(), 0);
  add_common(command, options.common);
}

void add_calibrate(CLI::App& app, Options& options) {
  auto& calibrate = options.calibrate;
  auto& command = *app.add_subcommand("calibrate", "Fit a study's free parameters to published figures");
  add_study_name(command, calibrate.study).required();
  command
      .add_option("--targets", calibrate.targets,
                  "File with the published figures, their tolerances and the free parameters")
      ->type_name("FILE");
  command.add_option("-o,--out", calibrate.out, "Write the calibrated study to this file")->type_name("FILE");
  add_threads(command, calibrate.threads);
  takes_integer(*command.add_option("--seed", calibrate.seed, "Random seed of the search (default: 1)"), 0);
  takes_integer(*command.add_option("--teams", calibrate.teams,
                                    "Teams per cell for each setting of the last design (default: 40)"),
                2, 100'000);
  takes_integer(*command.add_option("--confirm", calibrate.confirm,
                                    "Teams per cell to confirm the best settings (default: five times --teams)"),
                2, 1'000'000);
  command.add_flag("--quick", calibrate.quick, "Coarse search in about a tenth of the time");
  add_set(command, calibrate.set);
  command.add_flag("--yes", calibrate.yes, "Replace the file of -o if there is one");
  add_progress(command, calibrate.progress);
  add_common(command, options.common);
}

void add_report(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("report", "Write a run's figures, tests and methods as one web page");
  command.add_option("folder", options.report.folder, "Run folder")->required()->type_name("DIR");
  command.add_option("-o,--out", options.report.out, "Page to write (default: report.html in DIR); '-' is stdout")
      ->type_name("FILE");
  add_common(command, options.common);
}

void add_fit(CLI::App& app, Options& options) {
  auto& fit = options.fit;
  auto& command = *app.add_subcommand("fit", "Estimate how people learn from what they saw and answered");
  command.add_option("logs", fit.logs, "Run folders, tables with a row per trial, or the tables of 2021")
      ->required()
      ->type_name("LOGS");
  takes_word(*command.add_option("--method", fit.method, "How to fit")->capture_default_str(), "HOW",
             {"likelihood", "grid"});
  takes_word(
      *command.add_option("--answers", fit.answers, "What of an answer counts: the path, or whether it is right")
           ->capture_default_str(),
      "WHAT", {"path", "verdict"});
  takes_integer(*command.add_option("--types", fit.types, "Types of people without labels (default: as labelled)"), 1,
                6);
  takes_integer(
      *command.add_option("--folds", fit.folds, "Parts of the cross-validation; 0: none")->capture_default_str(), 0,
      1000);
  takes_integer(*command.add_option("--replicates", fit.replicates, "Runs of the particle filter per person")
                     ->capture_default_str(),
                1, 1000);
  takes_integer(*command.add_option("--seed", fit.seed, "Seed of all random streams")->capture_default_str(), 0);
  add_threads(command, fit.threads);
  command.add_option("-o,--out", fit.out, "Write the result to this file, as JSON")->type_name("FILE");
  command.add_flag("--yes", fit.yes, "Replace the file of -o if there is one");
  add_progress(command, fit.progress);
  add_common(command, options.common);
}

void add_power(CLI::App& app, Options& options) {
  auto& power = options.power;
  auto& command = *app.add_subcommand("power", "Estimate how many teams a study needs to show an effect");
  add_study_name(command, power.study).required();
  auto* effects = command
                      .add_option("--effect", power.effects,
                                  "Effect, such as 'periods: strategy eta2 = 0.02' (may be repeated; default: all)")
                      ->allow_extra_args(false)
                      ->type_name("EFFECT");
  command.add_option("--target", power.target, "Desired power")->capture_default_str()->type_name("P");
  command.add_option("--alpha", power.alpha, "Significance level")->capture_default_str()->type_name("P");
  takes_integer(
      *command
           .add_option("--teams", power.teams, "Teams per cell, separated by commas (default: 5,10,15,20,30,50,100)")
           ->delimiter(',')
           ->allow_extra_args(false),
      2, 100'000);
  takes_integer(
      *command.add_option("--pool", power.pool,
                          "Teams per cell to draw studies from, at least twice the largest of --teams (default: 1000)"),
      4, 1'000'000);
  takes_integer(*command.add_option("--draws", power.draws, "Studies drawn for each size")->capture_default_str(), 10,
                1'000'000);
  command.add_flag("--paired", power.paired,
                   "Every strategy teaches the same people; compare strategies within people");
  auto* findings =
      command
          .add_option("--findings", power.findings,
                      "Repeat the study and count how often the findings in this targets file are reproduced")
          ->type_name("FILE");
  findings->excludes(effects);
  command
      .add_option(
          "--preregister", power.preregister,
          "Write a preregistration of the study to this file: hypotheses, design, sample size, stopping, analyses")
      ->excludes(findings)
      ->type_name("FILE");
  takes_integer(*command.add_option("--studies", power.studies, "Repetitions for --findings")->capture_default_str(), 2,
                100'000);
  add_threads(command, power.threads);
  takes_integer(*command.add_option("--seed", power.seed, "Random seed (default: that of the study)"), 0);
  add_set(command, power.set);
  add_progress(command, power.progress);
  add_common(command, options.common);
}

void add_status(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("status", "Show the progress of a study: teams done, failed and left");
  command.add_option("folder", options.status.folder, "Run folder, also while the study is running")
      ->required()
      ->type_name("DIR");
  add_common(command, options.common);
}

void add_audit(CLI::App& app, Options& options) {
  auto& audit = options.audit;
  auto& command = *app.add_subcommand("audit", "Judge from people's answers who understands what");
  command.add_option("folder", audit.folder, "Run folder of a study, or folder of live sessions")
      ->required()
      ->type_name("DIR");
  takes_integer(*command.add_option("--team", audit.team, "Only this team of a run, as numbered in teams.csv"), 1);
  command.add_option("--room", audit.room, "Only this room of live sessions, by id or code")->type_name("ID");
  command.add_option("-o,--out", audit.out, "Write one HTML page for a browser; '-' is standard output")
      ->type_name("FILE");
  takes_number(*command
                    .add_option("--forgetting", audit.forgetting,
                                "Radians by which beliefs blur in a period without lessons; 0: people forget nothing")
                    ->capture_default_str(),
               {0.0, kLargestNumber}, "ANGLE");
  add_thread_count(command, audit.threads, "Worker threads (default: one per core)");
  add_progress(command, audit.progress);
  add_common(command, options.common);
}

void add_verify(CLI::App& app, Options& options) {
  auto& verify = options.verify;
  auto& command = *app.add_subcommand("verify", "Repeat a run from its frozen inputs and compare all bytes");
  command.add_option("folder", verify.folder, "Run folder")->required()->type_name("DIR");
  takes_number(*command.add_option("--sample", verify.sample, "Share of the teams to rerun, above 0, at most 1")
                    ->capture_default_str(),
               {0.0, 1.0, NumberRange::kAbove}, "P");
  add_thread_count(command, verify.threads, "Worker threads (default: one per core)");
  add_progress(command, verify.progress);
  add_common(command, options.common);
}

void add_merge(CLI::App& app, Options& options) {
  auto& merge = options.merge;
  auto& command = *app.add_subcommand("merge", "Merge the shards of a study and write its tables");
  command.add_option("folders", merge.folders, "Run folders of all shards, in any order")->required()->type_name("DIR");
  command.add_option("-o,--out", merge.out, "Run folder to create or to update")->type_name("DIR");
  command.add_flag("--yes", merge.yes, "Replace the results of a different study in the run folder");
  command.add_flag(
      "--allow-partial", merge.allow_partial,
      "Merge what can be read where shards or teams are missing; the manifest and reports say what is left "
      "out, and the exit code is 6");
  add_common(command, options.common);
}

}  // namespace

void add_study_commands(CLI::App& app, Options& options) {
  add_study(app, options);
  add_status(app, options);
  add_verify(app, options);
  add_merge(app, options);
  add_calibrate(app, options);
  add_power(app, options);
  add_analyze(app, options);
  add_report(app, options);
  add_fit(app, options);
  add_audit(app, options);
}

}  // namespace kith::cli
