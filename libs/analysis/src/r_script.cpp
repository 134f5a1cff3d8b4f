#include "kith/analysis/r_script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kith/table/codebook.hpp"
#include "kith/table/csv_writer.hpp"
#include "model_means.hpp"
#include "prepared_model.hpp"
#include "r_names.hpp"
#include "shown.hpp"

namespace kith {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n') {
      result += "\\n";
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string vector_of(const std::vector<std::string>& texts) {
  std::string result = "c(";
  for (std::size_t i = 0; i < texts.size(); ++i) result += (i == 0 ? "" : ", ") + quoted(texts[i]);
  return result + ")";
}

constexpr const char* kHelpers = R"R(
# Keeps a table in r-results/ under the caption that kith gives it.
dir.create("r-results", showWarnings = FALSE)
keep <- function(caption, table) {
  cat("\n", caption, "\n", sep = "")
  print(format(table, digits = 4), row.names = FALSE)
  file <- paste0(gsub("[^A-Za-z0-9]+", "_", caption), ".csv")
  write.csv(cbind(caption = caption, table), file.path("r-results", file), row.names = FALSE)
}
# A column of a table of emmeans, which leaves it out if nothing can be estimated.
of <- function(table, column) if (column %in% names(table)) table[[column]] else NA_real_
)R";

std::vector<std::string> columns_of(const PreparedModel& prepared, const ModelQuestion& question) {
  std::vector<std::string> columns{prepared.model.response};
  const auto add = [&](const std::string& column) {
    if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
  };
  for (const auto& factor : prepared.model.factors) add(factor.name);
  for (const auto& group : prepared.intercepts) {
    for (const auto& column : group) add(column);
  }
  if (question.observed) add(*question.observed);
  return columns;
}

class Script {
 public:
  Script(const Dataset& data, const PreparedModel& prepared, const ModelQuestion& question,
         const AnalysisOptions& options)
      : file_{data.file()},
        prepared_{prepared},
        model_{prepared.model},
        question_{question},
        options_{options},
        names_{columns_of(prepared, question)} {}

  std::string write() {
    head();
    const bool is_ordinal = model_.is_ordinal && model_.groups.empty();
    if (is_ordinal) {
      ordinal();
    } else if (model_.groups.empty()) {
      linear();
    } else {
      mixed();
    }
    if (!model_.terms.empty() && !is_ordinal) means();
    if (model_.is_count) counts();
    beyond();
    return std::move(text_);
  }

 private:
  void line(const std::string& text = "") { text_ += text + "\n"; }
  void keep(const std::string& caption, const std::string& indent = "") {
    line(fmt::format("{}keep({},", indent, quoted(caption)));
  }
  [[nodiscard]] const std::string& name_of(const std::string& column) const { return names_[column]; }
  [[nodiscard]] const std::string& response() const { return name_of(model_.response); }
  [[nodiscard]] std::string right_side() const {
    std::string text;
    for (const auto& term : model_.terms) {
      text += text.empty() ? "" : " + ";
      for (const auto factor : term) text += (factor == term.front() ? "" : ":") + name_of(model_.factors[factor].name);
    }
    return text.empty() ? "1" : text;
  }
  // R's terms with the names that the columns have in the file.
  [[nodiscard]] std::string labelled(const std::string& terms) const {
    return names_.renamed().empty() ? terms : "label(" + terms + ")";
  }
  [[nodiscard]] std::string level() const { return fmt::format("{}", 1.0 - options_.alpha); }
  [[nodiscard]] bool is_single() const { return model_.factors.size() == 1 && model_.terms.size() == 1; }

  void head() {
    line("# Repeats in R, table by table, what kith found in " + file_ + ",");
    line("# and goes on where kith stops. In the folder of this script:  Rscript analysis.R");
    line("# Needs (Debian): r-base r-cran-emmeans r-cran-car r-cran-lme4 r-cran-lmertest r-cran-survival r-cran-mass");
    line();
    line("library(car)");
    line("library(emmeans)");
    if (!model_.groups.empty()) line("library(lmerTest)  # lme4 with Satterthwaite's degrees of freedom");
    if (model_.is_count || model_.is_ordinal) line("library(MASS)");
    if (!model_.observed.empty()) line("library(survival)");
    text_ += kHelpers;
    line();
    line("data <- read.csv(\"data.csv\", check.names = FALSE, colClasses = \"character\", na.strings = character())");
    rename();
    line(fmt::format("data${0} <- as.numeric(data${0})", response()));
    for (const auto& factor : model_.factors)
      line(fmt::format("data${0} <- factor(data${0}, levels = {1})", name_of(factor.name), vector_of(factor.levels)));
    for (const auto& columns : prepared_.intercepts) {
      for (const auto& column : columns) {
        const auto is_column = [&](const Factor& factor) { return factor.name == column; };
        if (std::none_of(model_.factors.begin(), model_.factors.end(), is_column))
          line(fmt::format("data${0} <- factor(data${0})", name_of(column)));
      }
    }
    if (question_.observed)
      line(fmt::format("data${0} <- tolower(data${0}) == \"true\"", name_of(*question_.observed)));
  }

  // Columns get names that R takes without quotes; tables bear the names of the file.
  void rename() {
    const auto& renamed = names_.renamed();
    if (renamed.empty()) return;
    std::vector<std::string> plain;
    for (const auto& column : renamed) plain.push_back(names_[column]);
    line();
    line(
        "# Some functions of R fail for names such as `age group`: columns have simpler ones here, tables the true "
        "ones.");
    line("columns <- " + vector_of(renamed));
    line("names(columns) <- " + vector_of(plain));
    line("names(data)[match(columns, names(data))] <- names(columns)");
    line("label <- function(terms) vapply(strsplit(as.character(terms), \":\"), function(parts)");
    line("  paste(ifelse(parts %in% names(columns), columns[parts], parts), collapse = \":\"), \"\")");
    line();
  }

  void linear() {
    line();
    line(fmt::format("model <- lm({} ~ {}, data = data)", response(), right_side()));
    if (model_.terms.empty()) return;
    line("tests <- car::Anova(model, type = 2)");
    line("terms <- head(rownames(tests), -1)");
    keep(kAnovaCaption);
    line("     data.frame(term = " + labelled("terms") +
         ", df = tests[terms, \"Df\"], sum_of_squares = tests[terms, \"Sum Sq\"],");
    line("                f = tests[terms, \"F value\"], p_value = tests[terms, \"Pr(>F)\"]))");
    if (is_single()) {
      const auto formula = fmt::format("{} ~ {}", response(), name_of(model_.factors.front().name));
      line(fmt::format("welch <- oneway.test({}, data = data)", formula));
      keep(kWelchCaption);
      line(fmt::format("     data.frame(term = {}, f = unname(welch$statistic), p_value = welch$p.value))",
                       quoted(model_.factors.front().name)));
      line(fmt::format("kruskal.test({}, data = data)", formula));
    }
  }

  void ordinal() {
    line();
    line("# Ratings: only their order counts.");
    line(fmt::format("data${0} <- factor(data${0}, ordered = TRUE)", response()));
    line("# Its default stops at 1e-8, which is too early for p-values of four digits.");
    line(fmt::format("model <- polr({} ~ {}, data = data, Hess = TRUE, control = list(reltol = 1e-15, maxit = 1000))",
                     response(), right_side()));
    line("print(summary(model))");
    if (model_.terms.empty()) return;
    line("tests <- as.data.frame(car::Anova(model, type = 2))");
    keep(kOrdinalCaption);
    line("     data.frame(term = " + labelled("rownames(tests)") +
         ", df = tests[[\"Df\"]], chi_squared = tests[[\"LR Chisq\"]],");
    line("                p_value = tests[[\"Pr(>Chisq)\"]]))");
    for (const auto& factor : model_.factors) {
      if (factor.levels.size() < 2) continue;
      const bool is_family = factor.levels.size() > 2;
      line();
      line(fmt::format("means <- emmeans(model, {}, level = {})", quoted(name_of(factor.name)), level()));
      line(fmt::format(
          "pairs <- as.data.frame(summary(pairs(means, reverse = TRUE), adjust = {}, infer = TRUE, level = {}))",
          quoted(is_family ? "tukey" : "none"), level()));
      keep(pairs_caption(factor.name, "", is_family, Link::kLogit));
      line("     data.frame(pair = pairs$contrast, odds_ratio = exp(pairs$estimate),");
      line("                lower_limit = exp(pairs$asymp.LCL), upper_limit = exp(pairs$asymp.UCL),");
      line(fmt::format("                {} = pairs$p.value))", is_family ? "adjusted_p_value" : "p_value"));
    }
  }

  void mixed() {
    std::string intercepts;
    for (const auto& columns : prepared_.intercepts) {
      std::string name;
      for (const auto& column : columns) name += (name.empty() ? "" : ":") + name_of(column);
      intercepts += " + (1 | " + name + ")";
    }
    line();
    line("# Rows of a group are not independent: random intercepts.");
    line(fmt::format("model <- lmer({} ~ {}{}, data = data,", response(), right_side(), intercepts));
    // Small variances need more digits than the default gives.
    line("              control = lmerControl(optimizer = \"bobyqa\", optCtrl = list(rhoend = 1e-9)))");
    line("emm_options(lmer.df = \"satterthwaite\", lmerTest.limit = nrow(data), pbkrtest.limit = 0)");
    if (!model_.terms.empty()) {
      line("tests <- anova(model, type = 2)");
      keep(kMixedCaption);
      line("     data.frame(term = " + labelled("rownames(tests)") +
           ", df = tests[[\"NumDF\"]], f = tests[[\"F value\"]],");
      line("                p_value = tests[[\"Pr(>F)\"]]))");
    }
    line("variances <- as.data.frame(VarCorr(model))");
    line("groups <- variances$grp != \"Residual\"");
    keep(kVariancesCaption);
    line("     data.frame(rows_with_the_same = " + labelled("variances$grp[groups]") +
         ", variance = variances$vcov[groups],");
    line("                intraclass_correlation = (variances$vcov / sum(variances$vcov))[groups]))");
  }

  void means() {
    line();
    line("# Estimated marginal means and comparisons of them.");
    if (model_.groups.empty()) {
      line("residual_sd <- sigma(model)");
    } else {
      line("residual_sd <- sqrt(sum(variances$vcov))  # of a single row");
    }
    for (const auto& factor : model_.factors) means_of(factor);
    for (const auto& name : options_.by) {
      for (std::size_t by = 0; by < model_.factors.size(); ++by) {
        if (model_.factors[by].name != name) continue;
        for (std::size_t f = 0; f < model_.factors.size(); ++f) {
          if (f != by && interact(model_.terms, f, by)) simple_effects_of(model_.factors[f], name);
        }
      }
    }
  }

  // Whether some combination of levels has no rows.
  [[nodiscard]] bool has_empty_cells() const {
    std::set<std::vector<std::size_t>> cells;
    std::size_t all = 1;
    for (const auto& factor : model_.factors) all *= factor.levels.size();
    for (std::size_t i = 0; i < model_.values.size(); ++i) {
      std::vector<std::size_t> cell;
      for (const auto& factor : model_.factors) cell.push_back(factor.codes[i]);
      cells.insert(std::move(cell));
    }
    return cells.size() < all;
  }

  void means_of(const Factor& factor) {
    if (factor.levels.size() < 2) return;
    const bool is_family = factor.levels.size() > 2;
    line();
    line(fmt::format("means <- emmeans(model, {}, level = {})", quoted(name_of(factor.name)), level()));
    if (model_.factors.size() > 1 || !model_.groups.empty()) {
      line("shown <- as.data.frame(means)");
      keep(kMeansCaption + factor.name);
      line(fmt::format(
          "     setNames(data.frame(as.character(shown[[1]]), of(shown, \"emmean\"), of(shown, \"lower.CL\"), "
          "of(shown, \"upper.CL\")),"));
      line(fmt::format("              c({}, \"mean\", \"lower_limit\", \"upper_limit\")))", quoted(factor.name)));
    }
    const bool has_gaps = has_empty_cells();
    if (has_gaps) {
      line(
          "known <- which(!is.na(of(shown, \"emmean\")))  # only these levels are compared, and counted by Tukey's "
          "test");
      line("if (length(known) > 1) {");
    }
    const std::string indent = has_gaps ? "  " : "";
    // emmeans subtracts later levels from earlier ones; kith, as TukeyHSD(), the other way round.
    line(fmt::format(
        "{}pairs <- as.data.frame(summary(pairs(means{}, reverse = TRUE), adjust = {}, infer = TRUE, level = {}))",
        indent, has_gaps ? "[known]" : "", quoted(is_family ? "tukey" : "none"), level()));
    keep(pairs_caption(factor.name, "", is_family, Link::kIdentity), indent);
    line(indent + "     data.frame(pair = pairs$contrast, difference = pairs$estimate, lower_limit = pairs$lower.CL,");
    line(indent + "                upper_limit = pairs$upper.CL, d = pairs$estimate / residual_sd,");
    line(fmt::format("{}                {} = pairs$p.value))", indent, is_family ? "adjusted_p_value" : "p_value"));
    if (has_gaps) line("}");
    planned_of(factor);
    equivalence();
  }

  void simple_effects_of(const Factor& factor, const std::string& by) {
    const bool is_family = factor.levels.size() > 2;
    line();
    line(fmt::format("means <- emmeans(model, {}, by = {}, level = {})", quoted(name_of(factor.name)),
                     quoted(name_of(by)), level()));
    line(fmt::format(
        "pairs <- as.data.frame(summary(pairs(means, reverse = TRUE), adjust = {}, infer = TRUE, level = {}))",
        quoted(is_family ? "tukey" : "none"), level()));
    keep(pairs_caption(factor.name, by, is_family, Link::kIdentity));
    line(fmt::format(
        "     setNames(data.frame(as.character(pairs[[{}]]), pairs$contrast, pairs$estimate, pairs$lower.CL,",
        quoted(name_of(by))));
    line(
        fmt::format("                         pairs$upper.CL, pairs$p.value), c({}, \"pair\", \"difference\", "
                    "\"lower_limit\",",
                    quoted(by)));
    line(fmt::format("              \"upper_limit\", {})))", quoted(is_family ? "adjusted_p_value" : "p_value")));
  }

  void planned_of(const Factor& factor) {
    std::string list;
    std::size_t n = 0;
    for (const auto& contrast : options_.contrasts) {
      const auto known = [&](const auto& weight) {
        return std::find(factor.levels.begin(), factor.levels.end(), weight.level) != factor.levels.end();
      };
      const bool is_of = (contrast.factor.empty() || contrast.factor == factor.name) &&
                         std::all_of(contrast.weights.begin(), contrast.weights.end(), known);
      if (!is_of) continue;
      std::string weights;
      for (const auto& level : factor.levels) {
        double weight = 0.0;
        for (const auto& weighted : contrast.weights) {
          if (weighted.level == level) weight = weighted.weight;
        }
        weights += fmt::format("{}{}", weights.empty() ? "" : ", ", weight);
      }
      list += fmt::format("{}{} = c({})", n == 0 ? "" : ", ", quoted(contrast.name), weights);
      ++n;
    }
    if (n == 0) return;
    const bool is_family = n > 1 && options_.correction != Correction::kNone;
    const std::string how = !is_family                                 ? "none"
                            : options_.correction == Correction::kHolm ? "holm"
                            : options_.correction == Correction::kFdr  ? "fdr"
                                                                       : "bonferroni";
    line(fmt::format(
        "planned <- as.data.frame(summary(contrast(means, list({})), adjust = {}, infer = TRUE, level = {}))", list,
        quoted(how), level()));
    keep(planned_caption(factor.name, "", is_family ? std::optional{options_.correction} : std::nullopt));
    line("     data.frame(contrast = planned$contrast, difference = planned$estimate,");
    line("                lower_limit = of(planned, \"lower.CL\"), upper_limit = of(planned, \"upper.CL\"),");
    line(fmt::format("                {} = of(planned, \"p.value\")))", is_family ? "adjusted_p_value" : "p_value"));
  }

  void equivalence() {
    if (!options_.smallest_effect) return;
    const auto& smallest = *options_.smallest_effect;
    line(fmt::format(
        "test(pairs(means, reverse = TRUE), delta = {}, side = \"equivalence\", adjust = \"none\")",
        smallest.standardized ? fmt::format("{} * residual_sd", smallest.size) : fmt::format("{}", smallest.size)));
  }

  void counts() {
    std::string mains;
    for (const auto& factor : model_.factors) mains += (mains.empty() ? "" : " + ") + name_of(factor.name);
    if (mains.empty()) return;
    line();
    line("# Counts: quasi-Poisson regression, which estimates the dispersion, and negative binomial regression.");
    line(fmt::format("quasi <- glm({} ~ {}, family = quasipoisson, data = data)", response(), right_side()));
    line("print(summary(quasi))");
    if (model_.groups.empty() &&
        std::find(model_.observed.begin(), model_.observed.end(), false) == model_.observed.end()) {
      line("dispersion <- summary(quasi)$dispersion");
      line("tests <- car::Anova(quasi, type = 2, test.statistic = \"F\")");
      line("terms <- head(rownames(tests), -1)");
      line("if (dispersion < 1)  # else kith's regression is negative binomial");
      line("  keep(sprintf(\"F tests of the quasi-Poisson regression (type II, dispersion %.2f)\", dispersion),");
      line("       data.frame(term = " + labelled("terms") +
           ", df = tests[terms, \"Df\"], f = tests[terms, \"F value\"],");
      line("                  p_value = tests[terms, \"Pr(>F)\"]))");
    }
    line(fmt::format("try(print(summary(glm.nb({} ~ {}, data = data))), silent = TRUE)", response(), right_side()));
    if (!question_.observed) return;
    line();
    line("# Counts that were cut off.");
    line(
        fmt::format("print(survfit(Surv({}, {}) ~ {}, data = data))", response(), name_of(*question_.observed), mains));
    for (std::size_t f = 0; f < model_.factors.size(); ++f) {
      std::string strata;
      for (std::size_t g = 0; g < model_.factors.size(); ++g) {
        if (g != f) strata += (strata.empty() ? "" : ", ") + name_of(model_.factors[g].name);
      }
      line(fmt::format("print(survdiff(Surv({}, {}) ~ {}{}, data = data))", response(), name_of(*question_.observed),
                       name_of(model_.factors[f].name), strata.empty() ? "" : " + strata(" + strata + ")"));
    }
  }

  void beyond() {
    line();
    line("# Where kith stops. Remove the comment signs of what you need.");
    if (!model_.groups.empty()) {
      std::string name;
      for (const auto& column : prepared_.intercepts.front()) name += (name.empty() ? "" : ":") + name_of(column);
      if (model_.is_count)
        line(fmt::format("# glmer({} ~ {} + (1 | {}), family = poisson, data = data)", response(), right_side(), name));
      if (model_.is_binary)
        line(
            fmt::format("# glmer({} ~ {} + (1 | {}), family = binomial, data = data)", response(), right_side(), name));
      if (model_.is_ordinal)
        line(fmt::format("# library(ordinal); clmm(factor({}, ordered = TRUE) ~ {} + (1 | {}), data = data)",
                         response(), right_side(), name));
      if (!model_.factors.empty())
        line(fmt::format("# lmer({} ~ {} + ({} | {}), data = data)  # random slopes", response(), right_side(),
                         name_of(model_.factors.front().name), name));
      line("# confint(model, method = \"boot\")");
    } else {
      if (model_.is_ordinal) {
        line(fmt::format("# library(ordinal); clmm({} ~ {} + (1 | GROUP), data = data)  # random intercepts",
                         response(), right_side()));
        line(fmt::format("# nominal_test(clm({} ~ {}, data = data))  # proportional odds", response(), right_side()));
        return;
      }
      line("# plot(model)  # residuals");
      if (model_.is_binary)
        line(fmt::format("# glm({} ~ {}, family = binomial, data = data)", response(), right_side()));
      line(fmt::format("# library(BayesFactor); anovaBF({} ~ {}, data = data)", response(), right_side()));
    }
  }

  std::string file_;
  const PreparedModel& prepared_;
  const ModelData& model_;
  const ModelQuestion& question_;
  const AnalysisOptions& options_;
  RNames names_;
  std::string text_;
};

}  // namespace

RProject r_project(const Dataset& data, const ModelQuestion& question, const AnalysisOptions& options) {
  const auto prepared = prepare_model(data, question, options);
  RProject project;
  project.script = Script{data, prepared, question, options}.write();
  TableDescription table{.file = "data.csv", .description = "The rows of " + data.file() + " that were analysed."};
  const auto names = columns_of(prepared, question);
  for (const auto& name : names) {
    const bool is_response = name == prepared.model.response;
    Column column{.name = name, .type = is_response ? ColumnType::kReal : ColumnType::kText};
    column.kind = is_response && prepared.model.is_count ? ColumnKind::kCount : prepared.rows.kind(name);
    if (!is_response && column.kind == ColumnKind::kCount) column.kind = ColumnKind::kUnspecified;
    table.columns.push_back(std::move(column));
  }
  CsvWriter writer{table.columns, [&](std::string_view part) { project.data += part; }};
  for (std::size_t i = 0; i < prepared.rows.num_rows(); ++i) {
    writer.real(prepared.model.values[i]);
    for (std::size_t c = 1; c < names.size(); ++c) writer.text_or_missing(prepared.rows.cells(names[c])[i]);
    writer.end_row();
  }
  writer.flush();
  project.codebook = codebook(std::vector{std::move(table)});
  return project;
}

}  // namespace kith
