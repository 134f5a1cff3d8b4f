// The options of every command. With command_line.cpp the only file that includes CLI11, which takes long to compile.
#include "option_declarations.hpp"

#include <CLI/CLI.hpp>
#include <cctype>
#include <limits>
#include <map>

#include "kith/domains/export_model.hpp"
#include "kith/teaching/strategy.hpp"
#include "option_values.hpp"

namespace kith::cli {
namespace {

std::string variable_of(const std::string& long_name) {
  std::string name = "KITH_";
  for (const char c : long_name)
    name += c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

std::string braces(const std::vector<std::string>& words) {
  std::string text = "{";
  for (const auto& word : words) text += (text.size() > 1 ? "," : "") + word;
  return text + "}";
}

// An option whose value is one of a few words; help and completion list them.
CLI::Option& takes_word(CLI::Option& option, const std::string& type, const std::vector<std::string>& words) {
  return *option.check([words](const std::string& text) { return wrong_word(text, words); })
              ->type_name(type + ":" + braces(words));
}

CLI::Option& takes_integer(CLI::Option& option, std::int64_t min,
                           std::int64_t max = std::numeric_limits<std::int64_t>::max()) {
  return *option.check([min, max](const std::string& text) { return wrong_integer(text, min, max); })->type_name("N");
}

template <typename Mode>
void add_mode(CLI::App& command, const std::string& name, Mode& mode, const std::string& description,
              const std::string& type, const std::vector<std::pair<std::string, Mode>>& modes) {
  std::vector<std::string> words;
  for (const auto& one : modes) words.push_back(one.first);
  const auto set = [&mode, modes](const std::string& text) {
    for (const auto& one : modes) {
      if (one.first == text) mode = one.second;
    }
  };
  takes_word(*command.add_option_function<std::string>(name, set, description), type, words);
}

// Every option can be set in the environment; help and completion are written by us.
void add_common(CLI::App& command, CommonOptions& common) {
  command.set_help_flag();
  command.add_flag("--json", common.json, "Print one JSON document instead of text");
  add_mode<ColorMode>(command, "--color", common.color, "Colours on a terminal", "WHEN",
                      {{"auto", ColorMode::kAuto}, {"always", ColorMode::kAlways}, {"never", ColorMode::kNever}});
  command.add_flag("-q,--quiet", common.quiet, "Only results and errors");
  command.add_flag("-v,--verbose", common.verbosity, "Print more detail; repeat for more");
  for (auto* option : command.get_options()) {
    if (!option->get_lnames().empty()) option->envname(variable_of(option->get_lnames().front()));
  }
}

void add_validate(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("validate", "Check domain and study files");
  command
      .add_option("files", options.validate.files,
                  "Files to check, or names of what comes with kith; '-' is standard input")
      ->required()
      ->type_name("FILE");
  command.add_flag("--strict", options.validate.strict, "Let warnings count as errors");
  add_common(command, options.common);
}

void add_inspect(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("inspect", "Show a domain: map, reward, policy, and what can be taught");
  command.add_option("domain", options.inspect.domain, "Built-in domain or file")->required()->type_name("DOMAIN");
  takes_word(*command.add_option("--show", options.inspect.show, "What to show, separated by commas")
                  ->delimiter(',')
                  ->allow_extra_args(false),
             "PARTS", inspect_parts());
  takes_integer(*command.add_option("--mdp", options.inspect.mdp,
                                    "Number of the MDP to show (default: the last, with everything)"),
                0);
  command.add_flag("--all", options.inspect.all, "Do not shorten long lists");
  command.add_option("--svg", options.inspect.svg, "Write pictures to this folder: map, policy, region, coverage")
      ->type_name("DIR");
  add_common(command, options.common);
}

void add_init(CLI::App& app, Options& options) {
  auto& init = options.init;
  auto& command = *app.add_subcommand("init", "Write a domain, a study and a README to start from");
  command.add_option("folder", init.folder, "Where to write them")->capture_default_str()->type_name("DIR");
  takes_word(*command.add_option("--template", init.template_name, "What to start from")->capture_default_str(), "NAME",
             {"item-delivery", "blank", "human-study"});
  add_common(command, options.common);
}

void add_curriculum(CLI::App& app, Options& options) {
  auto& curriculum = options.curriculum;
  auto& command =
      *app.add_subcommand("curriculum", "Show what would be taught: demonstrations with reasons, and tests");
  command.add_option("domain", curriculum.domain, "Built-in domain or file")->required()->type_name("DOMAIN");
  command.add_option("-o,--out", curriculum.out, "Write one HTML page for a browser; '-' is standard output")
      ->type_name("FILE");
  takes_integer(*command.add_option("--seed", curriculum.seed, "Seed of all random streams")->capture_default_str(), 0);
  add_common(command, options.common);
}

void add_ask(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("ask", "Answer a question about the robot with demonstrations");
  command.add_option("domain", options.ask.domain, "Built-in domain or file")->required()->type_name("DOMAIN");
  command.add_option("question", options.ask.question, "Begins with when, where, why, what or how much")
      ->required()
      ->type_name("QUESTION");
  add_common(command, options.common);
}

void add_find(CLI::App& app, Options& options) {
  auto& find = options.find;
  auto& command = *app.add_subcommand("find", "Find or make a world that teaches or tests exactly one constraint");
  command.add_option("domain", find.domain, "Built-in domain or file")->required()->type_name("DOMAIN");
  command
      .add_option("constraint", find.constraint,
                  "A normal, such as '(-1,0,2)', or its sentence; without one, all that can be isolated are listed")
      ->type_name("CONSTRAINT");
  command.add_flag("--test", find.test, "For a test rather than for a demonstration");
  command.add_flag("--no-make", find.no_make, "Do not make a world where the domain has none");
  command.add_option("-o,--out", find.out, "Write the world to this file, as a domain of its own")->type_name("FILE");
  add_common(command, options.common);
}

void add_teach(CLI::App& app, Options& options) {
  auto& teach = options.teach;
  std::vector<std::string> names;
  for (const auto& kind : strategy_kinds()) names.emplace_back(kind.name);
  auto& command = *app.add_subcommand("teach", "Teach one simulated team and print a transcript");
  auto* domain = command.add_option("domain", teach.domain, "Built-in domain or file")->type_name("DOMAIN");
  auto* group =
      command.add_option("--group", teach.group, "The members' learner types, one letter each")->type_name("LETTERS");
  auto* strategy =
      &takes_word(*command.add_option("--strategy", teach.strategy, "Whose belief the lessons are chosen for")
                       ->capture_default_str(),
                  "NAME", names);
  auto* seed =
      &takes_integer(*command.add_option("--seed", teach.seed, "Seed of all random streams")->capture_default_str(), 0);
  auto* study = command.add_option("--study", teach.study, "Built-in study or file with the learner types")
                    ->capture_default_str()
                    ->type_name("STUDY");
  auto* set = command.add_option("--set", teach.set, "Set a key of the study (may be repeated)")
                  ->allow_extra_args(false)
                  ->type_name("KEY=VALUE");
  auto* from = command.add_option("--from", teach.from, "Replay a team of this run folder")->type_name("DIR");
  auto* team = command.add_option("--team", teach.team, "Number of the team, as in teams.csv")->type_name("N");
  from->needs(team);
  team->needs(from);
  for (auto* other : {domain, group, strategy, seed, study, set}) from->excludes(other);
  add_common(command, options.common);
}

void add_progress(CLI::App& command, ProgressMode& mode) {
  add_mode<ProgressMode>(command, "--progress", mode, "How to show progress, on stderr", "HOW",
                         {{"auto", ProgressMode::kAuto},
                          {"bar", ProgressMode::kBar},
                          {"json", ProgressMode::kJson},
                          {"none", ProgressMode::kNone}});
}

void add_shard(CLI::App& command, ShardOption& shard) {
  command
      .add_option_function<std::string>(
          "--shard", [&shard](const std::string& text) { shard = *shard_of(text); },
          "Run part I of N; kith merge combines the parts")
      ->check([](const std::string& text) {
        return shard_of(text) ? "" : "must be I/N, such as 2/7, with I from 1 to N, not '" + text + "'";
      })
      ->type_name("I/N");
}

void add_study(CLI::App& app, Options& options) {
  auto& study = options.study;
  auto& command = *app.add_subcommand("study", "Simulate all teams of a study and write its tables");
  command.add_option("study", study.study, "Built-in study or file; '-' is standard input")
      ->required()
      ->type_name("STUDY");
  command.add_option("-o,--out", study.out, "Run folder to create or to update")->type_name("DIR");
  takes_integer(*command.add_option("-j,--threads", study.threads,
                                    "Worker threads (default: one per core); never changes a result"),
                1, 1024);
  takes_integer(*command.add_option("--seed", study.seed, "The same as --set seed=N"), 0);
  command.add_option("--set", study.set, "Set a key of the study (may be repeated)")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  command.add_flag("--dry-run", study.dry_run, "Print what would be run, and run nothing");
  command.add_flag("--yes", study.yes, "Replace the results of a different study in the run folder");
  add_mode<ResumeMode>(command, "--resume", study.resume, "Whether to resume an earlier run", "WHEN",
                       {{"auto", ResumeMode::kAuto}, {"never", ResumeMode::kNever}, {"require", ResumeMode::kRequire}});
  add_shard(command, study.shard);
  auto* keep_going =
      command.add_flag("--keep-going", study.keep_going, "Continue after a team fails; exit 6 at the end");
  command.add_flag("--fail-fast")->description("Stop at the first team that fails (the default)")->excludes(keep_going);
  add_mode<ProgressMode>(command, "--progress", study.progress, "How to show progress, on stderr", "HOW",
                         {{"auto", ProgressMode::kAuto},
                          {"bar", ProgressMode::kBar},
                          {"json", ProgressMode::kJson},
                          {"none", ProgressMode::kNone}});
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
  command.add_option("--alpha", analyze.alpha, "Significance level; intervals use 1 - alpha")
      ->capture_default_str()
      ->check([](const std::string& text) { return wrong_level(text); })
      ->type_name("P");
  takes_word(*command
                  .add_option("--correct", analyze.correction,
                              "Correction for families of tests: compositions, planned contrasts")
                  ->capture_default_str(),
             "HOW", {"bonferroni", "holm", "fdr", "none"});
  takes_integer(*command.add_option("--permutations", analyze.permutations, "Permutations of permutation tests")
                     ->capture_default_str(),
                99, 1'000'000);
  takes_integer(*command
                     .add_option("--resamples", analyze.resamples,
                                 "No longer used: intervals come from the distributions of the tests")
                     ->capture_default_str(),
                100, 1'000'000);
  takes_integer(
      *command.add_option("--seed", analyze.seed, "Seed of permutations and resamples")->capture_default_str(), 0);
  add_common(command, options.common);
}

void add_calibrate(CLI::App& app, Options& options) {
  auto& calibrate = options.calibrate;
  auto& command = *app.add_subcommand("calibrate", "Fit a study's free parameters to published figures");
  command.add_option("study", calibrate.study, "Built-in study or file; '-' is standard input")
      ->required()
      ->type_name("STUDY");
  command
      .add_option("--targets", calibrate.targets,
                  "File with the published figures, their tolerances and the free parameters")
      ->type_name("FILE");
  command.add_option("-o,--out", calibrate.out, "Write the calibrated study to this file")->type_name("FILE");
  takes_integer(*command.add_option("-j,--threads", calibrate.threads,
                                    "Worker threads (default: one per core); never changes a result"),
                1, 1024);
  takes_integer(*command.add_option("--seed", calibrate.seed, "Random seed of the search (default: 1)"), 0);
  takes_integer(*command.add_option("--teams", calibrate.teams,
                                    "Teams per cell for each setting of the last design (default: 40)"),
                2, 100'000);
  takes_integer(*command.add_option("--confirm", calibrate.confirm,
                                    "Teams per cell to confirm the best settings (default: five times --teams)"),
                2, 1'000'000);
  command.add_flag("--quick", calibrate.quick, "Coarse search in about a tenth of the time");
  command.add_option("--set", calibrate.set, "Set a key of the study (may be repeated)")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
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
  takes_integer(*command.add_option("-j,--threads", fit.threads,
                                    "Worker threads (default: one per core); never changes a result"),
                1, 1024);
  command.add_option("-o,--out", fit.out, "Write the result to this file, as JSON")->type_name("FILE");
  command.add_flag("--yes", fit.yes, "Replace the file of -o if there is one");
  add_mode<ProgressMode>(command, "--progress", fit.progress, "How to show progress, on stderr", "HOW",
                         {{"auto", ProgressMode::kAuto},
                          {"bar", ProgressMode::kBar},
                          {"json", ProgressMode::kJson},
                          {"none", ProgressMode::kNone}});
  add_common(command, options.common);
}

void add_power(CLI::App& app, Options& options) {
  auto& power = options.power;
  auto& command = *app.add_subcommand("power", "Estimate how many teams a study needs to show an effect");
  command.add_option("study", power.study, "Built-in study or file; '-' is standard input")
      ->required()
      ->type_name("STUDY");
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
  takes_integer(*command.add_option("--pool", power.pool, "Teams per cell to draw studies from (default: 1000)"), 4,
                1'000'000);
  takes_integer(*command.add_option("--draws", power.draws, "Studies drawn for each size")->capture_default_str(), 10,
                1'000'000);
  command.add_flag("--paired", power.paired, "Every strategy teaches the same people");
  auto* findings =
      command
          .add_option("--findings", power.findings,
                      "Repeat the study and count how often the findings in this targets file are reproduced")
          ->type_name("FILE");
  findings->excludes(effects);
  takes_integer(*command.add_option("--studies", power.studies, "Repetitions for --findings")->capture_default_str(), 2,
                100'000);
  takes_integer(*command.add_option("-j,--threads", power.threads,
                                    "Worker threads (default: one per core); never changes a result"),
                1, 1024);
  takes_integer(*command.add_option("--seed", power.seed, "Random seed (default: that of the study)"), 0);
  command.add_option("--set", power.set, "Set a key of the study (may be repeated)")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  add_progress(command, power.progress);
  add_common(command, options.common);
}

void add_status(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("status", "Say how far a study is: done, failed, left, and for how long");
  command.add_option("folder", options.status.folder, "Run folder, also of a run that goes on")
      ->required()
      ->type_name("DIR");
  add_common(command, options.common);
}

void add_verify(CLI::App& app, Options& options) {
  auto& verify = options.verify;
  auto& command = *app.add_subcommand("verify", "Repeat a run from its frozen inputs and compare all bytes");
  command.add_option("folder", verify.folder, "Run folder")->required()->type_name("DIR");
  command.add_option("--sample", verify.sample, "Share of the teams to teach again, above 0, at most 1")
      ->capture_default_str()
      ->check([](const std::string& text) { return text == "1" ? "" : wrong_fraction(text); })
      ->type_name("P");
  takes_integer(*command.add_option("-j,--threads", verify.threads, "Worker threads (default: one per core)"), 1, 1024);
  add_progress(command, verify.progress);
  add_common(command, options.common);
}

void add_merge(CLI::App& app, Options& options) {
  auto& merge = options.merge;
  auto& command = *app.add_subcommand("merge", "Put the shards of a study together and write its tables");
  command.add_option("folders", merge.folders, "Run folders of all shards, in any order")->required()->type_name("DIR");
  command.add_option("-o,--out", merge.out, "Run folder to create or to update")->type_name("DIR");
  command.add_flag("--yes", merge.yes, "Replace the results of a different study in the run folder");
  command.add_flag(
      "--allow-partial", merge.allow_partial,
      "Merge what can be read where shards or teams are missing; the manifest and reports say what is left "
      "out, and the exit code is 6");
  add_common(command, options.common);
}

void add_export(CLI::App& app, Options& options) {
  auto& model = options.export_model;
  auto& command = *app.add_subcommand("export", "Write an MDP of a domain in the format of another program");
  command.add_option("domain", model.domain, "Built-in domain or file")->required()->type_name("DOMAIN");
  takes_word(*command.add_option("--to", model.format, "The format")->required(), "FORMAT", model_format_names());
  takes_integer(*command.add_option("--mdp", model.mdp, "Number of the MDP (default: the only one)"), 0);
  command
      .add_option("-o,--out", model.out,
                  "File to write (default: '-', stdout), or with prism what the names of all files begin with")
      ->type_name("FILE");
  command.add_flag("--yes", model.yes, "Replace existing files");
  add_common(command, options.common);
}

void add_bench(CLI::App& app, Options& options) {
  auto& bench = options.bench;
  auto& command = *app.add_subcommand("bench", "Time kernels and studies, against rivals and a saved baseline");
  command.add_flag("--quick", bench.quick, "A few seconds: fewer samples, every study once");
  command.add_option("--filter", bench.filter, "Only names that contain this; '*' matches any text, '|' means or")
      ->type_name("PATTERN");
  auto* save =
      command.add_option("--save", bench.save, "Write the figures to this file, as a baseline")->type_name("FILE");
  auto* baseline =
      command.add_option("--baseline", bench.baseline, "Compare with this file; exit 7 if something is slower")
          ->type_name("FILE");
  command.add_option("--tolerance", bench.tolerance, "How much slower a median may be, as a share")
      ->capture_default_str()
      ->needs(baseline)
      ->check([](const std::string& text) { return wrong_fraction(text); })
      ->type_name("P");
  auto* growth = command.add_flag("--growth", bench.growth, "How cost grows with the size of studies and domains");
  growth->excludes(save)->excludes(baseline);
  command.add_flag("--list", bench.list, "List the cases and their rivals; time nothing");
  takes_integer(*command.add_option("-j,--threads", bench.threads, "Threads of whole studies (default: one per core)"),
                1, 1024);
  command.add_flag("--yes", bench.yes, "Replace the file of --save if there is one");
  add_progress(command, bench.progress);
  add_common(command, options.common);
}

void add_explain(CLI::App& app, Options& options) {
  auto& command = *app.add_subcommand("explain", "Say what an error or warning id means");
  command.add_option("id", options.explain.id, "The id, such as E0207; without one, all are listed")->type_name("ID");
  add_common(command, options.common);
}

void add_others(CLI::App& app, Options& options) {
  auto& doctor = *app.add_subcommand("doctor", "Check that this machine can run kith");
  add_common(doctor, options.common);
  auto& completion = *app.add_subcommand("completion", "Print a shell's completion script");
  takes_word(*completion.add_option("shell", options.completion.shell, "The shell")->required(), "SHELL",
             {"bash", "zsh", "fish"});
  add_common(completion, options.common);
  auto& version = *app.add_subcommand("version", "Print version, commit and compiler (also: kith --version)");
  add_common(version, options.common);
}

}  // namespace

std::unique_ptr<CLI::App> make_app(Options& options) {
  auto app = std::make_unique<CLI::App>("Teach a robot's policy to a group of people by demonstration", "kith");
  app->set_help_flag();
  app->require_subcommand(1);
  add_init(*app, options);
  add_validate(*app, options);
  add_inspect(*app, options);
  add_curriculum(*app, options);
  add_ask(*app, options);
  add_find(*app, options);
  add_teach(*app, options);
  add_study(*app, options);
  add_status(*app, options);
  add_verify(*app, options);
  add_merge(*app, options);
  add_calibrate(*app, options);
  add_power(*app, options);
  add_analyze(*app, options);
  add_report(*app, options);
  add_fit(*app, options);
  add_bench(*app, options);
  add_export(*app, options);
  add_explain(*app, options);
  add_others(*app, options);
  return app;
}

Command command_of(const std::string& name) {
  static const std::map<std::string, Command> kCommands{
      {"report", Command::kReport},   {"validate", Command::kValidate},   {"inspect", Command::kInspect},
      {"teach", Command::kTeach},     {"study", Command::kStudy},         {"analyze", Command::kAnalyze},
      {"fit", Command::kFit},         {"doctor", Command::kDoctor},       {"completion", Command::kCompletion},
      {"version", Command::kVersion}, {"calibrate", Command::kCalibrate}, {"power", Command::kPower},
      {"status", Command::kStatus},   {"verify", Command::kVerify},       {"merge", Command::kMerge},
      {"export", Command::kExport},   {"bench", Command::kBench},         {"curriculum", Command::kCurriculum},
      {"ask", Command::kAsk},         {"init", Command::kInit},           {"find", Command::kFind},
      {"explain", Command::kExplain}};
  return kCommands.at(name);
}

const std::vector<std::string>& inspect_parts() {
  static const std::vector<std::string> kParts{"map", "policy", "bec", "kc", "demos", "tests", "counterfactuals"};
  return kParts;
}

}  // namespace kith::cli
