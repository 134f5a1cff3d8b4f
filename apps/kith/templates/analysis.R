# analysis.R DATA.csv PLAN.json: tests a model on a table and prints what it finds as JSON.
#
# kith analyze runs it; `kith analyze TABLE --model FORMULA --r FOLDER` writes it with data and plan, so that you can
# repeat and change the analysis:
#
#   cd FOLDER && Rscript analysis.R data.csv plan.json
#
# Needs (Debian): r-base-core r-cran-lme4 r-cran-lmertest r-cran-emmeans r-cran-car r-cran-mass r-cran-ordinal
#   r-cran-survival r-cran-jsonlite
#
# The plan has the members
#   formula          as in R: "knowledge ~ strategy*composition + (1|team)"; columns of numbers on the right are
#                    covariates, all others factors with levels in the order of appearance
#   response         "number", "count" or "ordinal"
#   observed         a column that is false where a count is only a lower bound (censored)
#   identifiers      whom or what a row is about, ["team", "team:member"]: if these repeat and the formula has no random
#                    intercepts, it gets them; `independent`: true if it should not
#   alpha, correction ("bonferroni", "holm", "fdr", "none"), by (factors), smallest_effect {size, standardized},
#   contrasts        [{name, factor, weights: {level: weight}}]
# of which all but the first may be missing.

suppressPackageStartupMessages({
  for (package in c("car", "emmeans", "jsonlite", "lmerTest", "MASS", "ordinal", "survival")) {
    if (!requireNamespace(package, quietly = TRUE)) stop("R has no package ", package, call. = FALSE)
  }
  library(lmerTest)  # lme4 with Satterthwaite's degrees of freedom
  library(emmeans)
})

# --- what is printed ------------------------------------------------------------------------------------------------

found <- list(warnings = character(), notes = character(), tables = list(), methods = list(), tests = NULL,
    means = list())
warn <- function(...) found$warnings <<- unique(c(found$warnings, paste0(...)))
note <- function(...) found$notes <<- c(found$notes, paste0(...))
method <- function(text, source = "") found$methods <<- c(found$methods, list(list(text = text, source = source)))

# Keeps a table. What its columns hold is seen from their heads; `blank` rows lack what they do not have.
kind_of <- function(name, column) {
  if (!is.numeric(column)) return("text")
  if (grepl("p-value", name)) return("p")
  if (grepl("^(df|n|groups|censored|[0-9]+)$", name)) return("count")
  if (grepl("eta squared|^d(,|$)|correlation", name)) return("fraction")
  "number"
}
keep <- function(caption, table, blank = 0, kinds = NULL) {
  heads <- names(table)
  fields <- make.unique(gsub("^_|_$", "", gsub("[^a-z0-9\x80-\xff]+", "_", gsub("'", "", tolower(heads)),
      useBytes = TRUE)), "_")
  fields <- ifelse(heads %in% found$columns, heads, sub("_1$", "_2", fields))
  if (is.null(kinds)) kinds <- mapply(kind_of, heads, table)
  if ("partial eta squared" %in% heads) kinds[grepl(" limit$", heads)] <- "fraction"
  rows <- lapply(seq_len(nrow(table)), function(i) {
    row <- setNames(lapply(table, function(column) if (is.factor(column)) as.character(column[i]) else column[i]),
        fields)
    if (i > nrow(table) - blank) row[!is.na(row)] else row
  })
  columns <- data.frame(field = fields, name = heads, kind = unname(unlist(kinds)))
  found$tables <<- c(found$tables, list(list(caption = caption, columns = columns, rows = rows)))
}

shown_p <- function(p) if (p < 0.0005) "p < 0.001" else sprintf("p = %.3f", p)
shown <- function(x) {
  size <- abs(x)
  if (is.na(x) || size == 0) return(as.character(x))
  if (size < 1e-4 || size >= 1e7) return(sprintf("%.2e", x))
  magnitude <- floor(log10(size))
  sprintf("%.*f", if (magnitude < -2) 1 - magnitude else min(max(3 - magnitude, 0), 3), x)
}
listed <- function(x) if (length(x) < 2) x else paste(paste(head(x, -1), collapse = ", "), "and", tail(x, 1))
capital <- function(x) if (grepl("^[a-z ]{3,}$", x)) paste0(toupper(substr(x, 1, 1)), substring(x, 2)) else x
per_cent <- function(level) sprintf("%.3g %%", 100 * level)

# --- the data -------------------------------------------------------------------------------------------------------

# Numbers become numbers, everything else factors; true and false stay as they are until one is a response.
read_table <- function(file) {
  data <- read.csv(file, check.names = FALSE, colClasses = "character", na.strings = c("", "NA"), encoding = "UTF-8")
  data[] <- lapply(data, function(column) {
    number <- suppressWarnings(as.numeric(column))
    if (!any(is.na(number) & !is.na(column)) && any(!is.na(column))) number else factor(column,
        levels = unique(na.omit(column)))
  })
  data
}

# Some functions of R fail for names such as `age group`: columns have simpler ones here, tables the true ones.
plain_names <- function(expression, plain) {
  name <- if (is.name(expression)) as.character(expression) else ""
  if (name %in% names(plain)) return(as.name(plain[[name]]))
  if (is.call(expression)) expression[-1] <- lapply(as.list(expression)[-1], plain_names, plain)
  expression
}

read_plan <- function(file) {
  plan <- jsonlite::fromJSON(file, simplifyVector = FALSE)
  default <- list(response = "", observed = "", identifiers = list(), independent = FALSE, alpha = 0.05,
                  correction = "bonferroni", contrasts = list(), by = list(), smallest_effect = NULL)
  default[names(plan)] <- plan
  default
}

prepare <- function(data, plan) {
  formula <- tryCatch(as.formula(plan$formula), error = function(e)
    stop("the model '", plan$formula,
        "' cannot be read; write RESPONSE ~ FACTORS, such as 'knowledge ~ strategy*composition'"))
  if (length(formula) != 3) stop("the model '", plan$formula, "' has no response; write RESPONSE ~ FACTORS")
  used <- all.vars(formula)
  for (name in c(used, if (plan$observed != "") plan$observed, unlist(strsplit(as.character(plan$identifiers), ":")))) {
    if (!name %in% names(data)) stop("there is no column '", name, "'; the columns are ", listed(names(data)))
  }
  plain <- setNames(make.names(names(data), unique = TRUE), names(data))
  formula <- as.formula(plain_names(formula, plain))
  complete <- complete.cases(data[c(used, if (plan$observed != "") plan$observed)])
  if (!any(complete)) stop("no row has a value in every column of the model, which are ", listed(used))
  if (!all(complete)) {
    missing <- colSums(is.na(data[used]))
    note(sum(!complete), " of ", nrow(data), " rows left out because of missing values (",
         paste0(names(missing[missing > 0]), ": ", missing[missing > 0], collapse = ", "), ")")
  }
  found$columns <<- names(data)
  names(data) <- plain
  data <- droplevels(data[complete, , drop = FALSE])
  fixed <- reformulas_nobars(formula)
  model <- list(data = data, formula = formula, response = as.character(formula[[2]])[1], label = names(plain),
      plain = plain,
                variables = setdiff(all.vars(fixed[[3]]), "."))
  for (name in model$variables) {
    column <- data[[name]]
    if (length(unique(column)) < 2)
      stop("column '", true_name(model, name), "' is '", column[1], "' in every row, so there is nothing to compare")
    if (is.factor(column) && nlevels(column) > 200)
      stop("column '", true_name(model, name), "' has ", nlevels(column), " different values; a factor has at most 200")
  }
  # factor(x) in the formula is the column x as a factor.
  wrapped <- intersect(model$variables, gsub("^factor\\(|\\)$", "", grep("^factor\\(", attr(terms(fixed),
      "term.labels"), value = TRUE)))
  for (name in wrapped) model$data[[name]] <- factor(data[[name]], levels = unique(data[[name]]))
  model$formula <- as.formula(strip_factor(model$formula))
  model$factors <- Filter(function(name) is.factor(model$data[[name]]), model$variables)
  model$covariates <- setdiff(model$variables, model$factors)
  response_of(model, plan)
}

strip_factor <- function(e) {
  if (is.call(e) && identical(e[[1]], as.name("factor"))) return(e[[2]])
  if (is.call(e)) e[-1] <- lapply(as.list(e)[-1], strip_factor)
  e
}
reformulas_nobars <- function(formula) {
  fixed <- lme4::nobars(formula)
  if (length(fixed) == 3) fixed else as.formula(call("~", formula[[2]], 1))
}
true_name <- function(model, terms) vapply(strsplit(as.character(terms), ":"), function(parts) {
  at <- match(parts, model$plain)
  paste(ifelse(is.na(at), parts, model$label[at]), collapse = ":")
}, "")

response_of <- function(model, plan) {
  values <- model$data[[model$response]]
  name <- true_name(model, model$response)
  model$is_binary <- is.factor(values) && all(tolower(levels(values)) %in% c("true", "false"))
  if (model$is_binary) values <- as.numeric(tolower(values) == "true")
  if (is.factor(values)) {
    texts <- levels(values)[is.na(suppressWarnings(as.numeric(levels(values))))]
    stop("column '", name, "' holds text, such as '", texts[1], "'; choose a column of numbers")
  }
  if (any(abs(values) > 1e100)) stop("column '", name, "' has values that are too large for a variance to be computed")
  model$is_binary <- model$is_binary || all(values %in% 0:1)
  model$kind <- if (plan$response != "") plan$response else if (plan$observed != "") "count" else "number"
  if (model$kind == "count" && any(values < 0 | values != floor(values)))
    stop("column '", name, "' has values that are no counts; counts are whole numbers from 0")
  if (length(unique(values)) < 2) stop("column '", name, "' is ", values[1],
      " in every row, so there is nothing to explain")
  if (model$is_binary && model$kind == "number")
    note(name,
        " is true or false (1 or 0), so its means are proportions, but a linear model is fitted: its limits can be ",
         "below 0 or above 1")
  model$data[[model$response]] <- values
  model
}

# Rows with the same identifier, such as "team" or "team:member", belong together.
add_intercepts <- function(model, plan) {
  n <- nrow(model$data)
  groups <- list()
  if (length(lme4::findbars(model$formula)) == 0) for (id in unlist(plan$identifiers)) {
    columns <- model$plain[strsplit(id, ":")[[1]]]
    if (any(columns %in% all.vars(model$formula))) next
    group <- interaction(model$data[columns], drop = TRUE)
    same <- function(other) nlevels(other) == nlevels(group) && nlevels(interaction(other, group,
        drop = TRUE)) == nlevels(group)
    if (nlevels(group) > 1 && nlevels(group) < n && !any(vapply(groups, same, TRUE))) groups[[paste(columns,
        collapse = ":")]] <- group
  }
  if (length(groups) > 0) {
    intercepts <- paste0("(1|", true_name(model, names(groups)), ")", collapse = " + ")
    if (isTRUE(plan$independent)) {
      warn("identifiers repeat (", intercepts,
          "), but rows are analysed as independent, as requested: if rows of a group ",
           "are alike, p-values are too small")
    } else {
      note("identifiers repeat, so the model has random intercepts, ", intercepts,
          "; to choose others, write them into ",
           "the formula, or use --independent")
      model$formula <- update(model$formula, paste(". ~ . +", paste0("(1|", names(groups), ")", collapse = " + ")))
    }
  }
  bars <- lme4::findbars(model$formula)
  for (name in unique(unlist(lapply(bars, all.vars)))) model$data[[name]] <- factor(model$data[[name]])
  for (bar in bars) {
    group <- interaction(model$data[all.vars(bar[[3]])], drop = TRUE)
    if (nlevels(group) < 2) stop("all rows have the same ", true_name(model, deparse(bar[[3]])))
    if (nlevels(group) == n && identical(bar[[2]], 1))
      stop("every row has a ", true_name(model, deparse(bar[[3]])), " of its own, so it can be no random intercept")
  }
  model$is_mixed <- length(bars) > 0
  model$fixed <- reformulas_nobars(model$formula)
  model$terms <- attr(terms(model$fixed), "term.labels")
  model$shown <- paste(name_of_formula(model, model$formula), collapse = " ")
  model
}
name_of_formula <- function(model, formula) {
  true <- setNames(as.list(model$label), model$plain)
  gsub("\\(1 \\| ([^)]*)\\)", "(1|\\1)", paste(deparse(plain_names(formula, true), width.cutoff = 500), collapse = ""))
}

# --- tests of terms -------------------------------------------------------------------------------------------------

# Partial eta squared with the interval that does not contain 0 exactly if p < alpha (non-central F distribution).
eta_squared <- function(f, df1, df2, alpha) {
  limit <- function(p) {
    if (!is.finite(f) || pf(f, df1, df2) < p) return(0)
    excess <- function(lambda) pf(f, df1, df2, lambda) - p
    high <- max(10, f * df1)
    while (excess(high) > 0) high <- 2 * high
    lambda <- uniroot(excess, c(0, high), tol = 1e-10 * high)$root
    lambda / (lambda + df1 + df2 + 1)
  }
  estimate <- f * df1 / (f * df1 + df2)
  c(estimate, limit(1 - alpha), max(limit(alpha), estimate))
}
with_eta <- function(tests, f, df1, df2, alpha) {
  eta <- vapply(seq_along(f), function(i) if (is.na(f[i])) rep(NA_real_, 3) else eta_squared(f[i], df1[i], df2[i],
      alpha), numeric(3))
  cbind(tests, setNames(as.data.frame(t(eta)), c("partial eta squared", "lower limit", "upper limit")))
}
set_tests <- function(statistic, subject, df, residual, value, p)
  found$tests <<- list(statistic = statistic,
                       tests = data.frame(subject = subject, df = df, residual_df = residual, statistic = value, p = p))

size_words <- c("negligible", "small", "medium", "large")  # [cohen1988]
size_of <- function(eta) size_words[1 + sum(eta >= c(0.01, 0.06, 0.14))]
term_sentence <- function(model, term, p, eta, means, alpha) {
  parts <- true_name(model, strsplit(term, ":")[[1]])
  if (is.na(p)) return(paste0("The effect of ", listed(parts), " cannot be tested."))
  if (p >= alpha && length(parts) > 1) return(paste0("No interaction of ", listed(parts), " was found (", shown_p(p),
      ")."))
  if (p >= alpha) return(paste0("No effect of ", parts, " was found (", shown_p(p), ")."))
  size <- if (any(is.na(eta))) "" else paste(unique(c(size_of(eta[2]), size_of(eta[3]))), collapse = " to ")
  if (length(parts) > 1)
    return(paste0(capital(listed(parts)), " interact (", if (size != "") paste0(size, " effect, "), shown_p(p), ")."))
  range <- means[[term]]
  text <- ""
  if (!is.null(range) && !anyNA(range$mean)) {
    least <- which.min(range$mean)
    most <- which.max(range$mean)
    text <- paste0(": estimated marginal means range from ", shown(range$mean[least]), " (", range$level[least],
        ") to ",
                   shown(range$mean[most]), " (", range$level[most], ")")
  }
  paste0(capital(parts), " has ", if (size == "") "an" else paste("a", size), " effect (", shown_p(p), ")", text, ".")
}

# Likelihood-ratio tests of type II: each term against the model of all terms that do not contain it.
likelihood_ratios <- function(model, fit_with) {
  contains <- function(term, other) all(strsplit(other, ":")[[1]] %in% strsplit(term, ":")[[1]])
  intercepts <- vapply(lme4::findbars(model$formula), function(bar) paste0("(", deparse(bar), ")"), "")
  likelihood <- function(terms) {
    right <- c(if (length(terms)) terms else "1", intercepts)
    logLik(fit_with(reformulate(right, model$fixed[[2]])))
  }
  rows <- lapply(model$terms, function(term) {
    others <- Filter(function(other) !contains(other, term), model$terms)
    without <- likelihood(others)
    with <- likelihood(c(others, term))
    df <- attr(with, "df") - attr(without, "df")
    chi <- max(0, 2 * as.numeric(with - without))
    data.frame(term = term, df = df, chi = chi, p = if (df > 0) pchisq(chi, df, lower.tail = FALSE) else NA_real_)
  })
  do.call(rbind, rows)
}
keep_ratios <- function(model, caption, tests) {
  if (is.null(found$tests)) set_tests("chi-squared", true_name(model, tests$term), tests$df, NA, tests$chi, tests$p)
  keep(caption, data.frame(term = true_name(model, tests$term), df = tests$df, "chi-squared" = tests$chi,
                           "p-value" = tests$p, check.names = FALSE))
}

# --- means and comparisons ------------------------------------------------------------------------------------------

column <- function(table, ...) {
  for (name in c(...)) if (name %in% names(table)) return(table[[name]])
  rep(NA_real_, nrow(table))
}
limits <- function(table) list(column(table, "lower.CL", "asymp.LCL"), column(table, "upper.CL", "asymp.UCL"))

# The scale on which a model compares: differences, ratios (of a log link) or odds ratios.
compared <- function(model, table, first, at, by, p_head, corrected = NULL) {
  through <- if (model$scale == "difference") identity else exp
  ends <- limits(table)
  rows <- data.frame(as.character(table$contrast), through(table$estimate), through(ends[[1]]), through(ends[[2]]))
  names(rows) <- c(first, model$scale, "lower limit", "upper limit")
  if (model$scale == "difference" && is.finite(model$sd))
    rows <- cbind(rows, d = table$estimate / model$sd, "d, lower limit" = ends[[1]] / model$sd,
        "d, upper limit" = ends[[2]] / model$sd)
  rows[[p_head]] <- table$p.value
  if (!is.null(corrected)) rows[["corrected p-value"]] <- corrected
  if (!is.null(by)) rows <- cbind(setNames(data.frame(as.character(at)), by), rows)
  rows
}

grid_of <- function(model, plan, factor, by = NULL)
  suppressMessages(do.call(emmeans, c(list(model$fit, factor, by = by, level = 1 - plan$alpha, data = model$data),
      model$mode)))

equivalence <- function(model, plan, grid, what, names, p_difference) {
  smallest <- plan$smallest_effect
  if (is.null(smallest) || model$scale != "difference") return("")
  margin <- smallest$size * if (isTRUE(smallest$standardized)) model$sd else 1
  table <- as.data.frame(summary(grid, adjust = "none", infer = TRUE, level = 1 - 2 * plan$alpha))
  # Two one-sided tests [schuirmann1987].
  p <- pt((abs(table$estimate) - margin) / table$SE, table$df)
  differs <- p_difference < plan$alpha
  verdict <- ifelse(p < plan$alpha, ifelse(differs, "different, but equivalent", "equivalent"), ifelse(differs,
      "different", "undecided"))
  ends <- limits(table)
  keep(sprintf("Equivalence within %s (%s; two one-sided tests%s, %s intervals)", shown(margin), what,
               if (nrow(table) > 1) ", uncorrected" else "", per_cent(1 - 2 * plan$alpha)),
       data.frame(comparison = names, difference = table$estimate, "lower limit" = ends[[1]],
                  "upper limit" = ends[[2]], "p-value" = p, verdict = verdict, check.names = FALSE))
  method(paste("two one-sided tests of equivalence within", shown(margin)))
  few <- sum(p < plan$alpha, na.rm = TRUE)
  sprintf(" %s %s %s shown to be smaller than %s (%s).", if (few == 0) "None of the" else paste(few, "of the"),
          if (nrow(table) == 1) "one difference" else paste(nrow(table),
              "differences"), if (few > 1) "were" else "was", shown(margin), what)
}

# All pairs of levels, later ones less earlier ones, as the studentised range adjusts them.
pairs_of <- function(model, plan, factor, by = NULL) {
  levels <- levels(model$data[[factor]])
  family <- length(levels) > 2
  if (length(levels) > 12) return("")
  grid <- grid_of(model, plan, factor, by)
  known <- which(!is.na(column(as.data.frame(grid), "emmean", "rate", "response")))
  if (is.null(by) && length(known) < length(levels)) {
    if (length(known) < 2) {
      warn("the levels of ", true_name(model, factor), " cannot be compared: some combinations of levels have no rows")
      return("")
    }
    warn("levels of ", true_name(model, factor), " without rows in some combinations are not compared: ",
        listed(levels[-known]))
    grid <- grid[known]
    levels <- levels[known]
  }
  pairs <- pairs(grid, reverse = TRUE)
  table <- as.data.frame(summary(pairs, adjust = if (family) "tukey" else "none", infer = TRUE, level = 1 - plan$alpha))
  each <- do.call(c, lapply(2:length(levels), function(i) paste(levels[i], "-", levels[seq_len(i - 1)])))
  table$contrast <- if (nrow(table) %% length(each) == 0) rep(each, nrow(table) / length(each)) else table$contrast
  at <- if (is.null(by)) NULL else table[[by]]
  how <- if (family) "Tukey-Kramer" else if (model$scale == "difference") "t test" else "Wald test"
  where <- if (is.null(by)) how else paste0("at each level of ", true_name(model, by), if (family) paste0("; ", how))
  keep(paste0(model$about, "Pairs of ", true_name(model, factor), " (", where, ")"),
       compared(model, table, "pair", at, if (!is.null(by)) true_name(model, by),
           if (family) "adjusted p-value" else "p-value"))
  if (family) method("Tukey-Kramer tests for pairs of estimated marginal means", "kramer1956")
  equivalence(model, plan, pairs, paste0("pairs of ", true_name(model, factor), if (!is.null(by)) paste(" within",
      true_name(model, by))),
              if (is.null(by)) table$contrast else paste0(at, ": ", table$contrast), table$p.value)
}

correction_name <- function(plan) c(bonferroni = "Bonferroni", holm = "Holm",
    fdr = "Benjamini-Hochberg")[[plan$correction]]

planned_of <- function(model, plan, factor, contrasts, by = NULL) {
  levels <- levels(model$data[[factor]])
  weights <- lapply(contrasts, function(one) vapply(levels, function(level) as.numeric(c(one$weights[[level]], 0)[1]),
      0))
  names(weights) <- vapply(contrasts, function(one) one$name, "")
  grid <- grid_of(model, plan, factor, by)
  result <- contrast(grid, weights)
  family <- is.null(by) && length(contrasts) > 1 && plan$correction != "none"
  table <- as.data.frame(summary(result, adjust = if (family) plan$correction else "none", infer = TRUE,
      level = 1 - plan$alpha))
  table$contrast <- rep(names(weights), length.out = nrow(table))
  how <- if (family) sprintf(" (%s correction)", correction_name(plan)) else ""
  corrected <- if (!is.null(by) && plan$correction != "none") p.adjust(table$p.value, plan$correction)
  at <- if (is.null(by)) NULL else table[[by]]
  keep(paste0("Planned contrasts of ", true_name(model, factor), if (!is.null(by)) paste(" at each level of",
      true_name(model, by)), how),
       compared(model, table, "contrast", at, if (!is.null(by)) true_name(model, by),
                if (family) "adjusted p-value" else "p-value", corrected))
  method(paste0("planned contrasts of estimated marginal means", how))
  ends <- limits(table)
  through <- if (model$scale == "difference") identity else exp
  text <- if (is.null(by)) paste0(sprintf(" %s: %s [%s, %s], %s.", table$contrast, vapply(through(table$estimate),
      shown, ""),
      vapply(through(ends[[1]]), shown, ""), vapply(through(ends[[2]]), shown, ""), vapply(table$p.value, shown_p,
          "")), collapse = "") else ""
  paste0(text, equivalence(model, plan, result, paste0("planned contrasts", if (!is.null(by)) paste(" within",
      true_name(model, by))),
                           if (is.null(by)) table$contrast else paste0(at, ": ", table$contrast), table$p.value))
}

# What each contrast is about: the factor it names, or the first that has all its levels.
factor_of <- function(model, one) {
  has <- function(name) all(names(one$weights) %in% levels(model$data[[name]]))
  wanted <- if (is.null(one$factor) || one$factor == "") model$factors else intersect(model$plain[one$factor],
      model$factors)
  fitting <- Filter(has, wanted)
  if (length(fitting) == 0)
    stop("contrast '", one$name, "': no factor of the model has the levels ", listed(paste0("'", names(one$weights),
        "'")))
  fitting[1]
}
interact <- function(model, a, b) any(vapply(strsplit(model$terms, ":"), function(parts) all(c(a, b) %in% parts), TRUE))

compare <- function(model, plan, contrasts = TRUE) {
  if (length(model$factors) == 0) return("")
  method("estimated marginal means", "searle1980")
  text <- ""
  for (factor in model$factors) text <- paste0(text, pairs_of(model, plan, factor))
  if (!contrasts) return(text)
  by <- model$plain[unlist(plan$by)]
  for (name in setdiff(by, model$factors))
    stop("--by ", name, ": the model has no factor of this name, but ", listed(true_name(model, model$factors)))
  of <- vapply(plan$contrasts, function(one) factor_of(model, one), "")
  for (factor in model$factors) {
    for (other in setdiff(by, factor)) {
      if (interact(model, factor, other)) text <- paste0(text, pairs_of(model, plan, factor, other))
      else warn("the model has no interaction of ", true_name(model, factor), " and ", true_name(model, other),
                ", so differences between levels of one are the same at every level of the other")
    }
    chosen <- plan$contrasts[of == factor]
    if (length(chosen) == 0) next
    text <- paste0(text, planned_of(model, plan, factor, chosen))
    for (other in setdiff(by, factor)) if (interact(model, factor, other)) planned_of(model, plan, factor, chosen,
        other)
  }
  text
}

means_of <- function(model, plan, is_kept) {
  means <- list()
  for (factor in model$factors) {
    if (nlevels(model$data[[factor]]) > 60) next
    table <- as.data.frame(suppressMessages(emmeans(model$fit, factor, level = 1 - plan$alpha)))
    ends <- limits(table)
    means[[factor]] <- data.frame(level = as.character(table[[1]]), mean = column(table, "emmean"), low = ends[[1]],
        high = ends[[2]],
                                  n = as.vector(table(model$data[[factor]])))
    found$means <<- c(found$means, list(list(factor = true_name(model, factor), means = means[[factor]])))
    if (is_kept) keep(paste("Estimated marginal means of", true_name(model, factor)),
                      setNames(means[[factor]], c(true_name(model, factor), "mean", "lower limit", "upper limit", "n")))
  }
  means
}

# How the response changes with a covariate: its average slope.
slopes_of <- function(model, plan) {
  rows <- lapply(model$covariates, function(name) {
    trend <- as.data.frame(suppressMessages(do.call(emtrends, c(list(model$fit, ~1, var = name,
        level = 1 - plan$alpha, data = model$data), model$mode))))
    ends <- limits(trend)
    data.frame(covariate = true_name(model, name), slope = column(trend, paste0(name, ".trend")),
        "lower limit" = ends[[1]],
               "upper limit" = ends[[2]], check.names = FALSE)
  })
  if (length(rows) > 0) keep("Slopes of covariates", do.call(rbind, rows))
}

raw_means <- function(model, plan, with_limits) {
  cells <- prod(vapply(model$factors, function(name) nlevels(model$data[[name]]), 1))
  if (length(model$factors) == 0 || cells > 60) return()
  grid <- rev(expand.grid(rev(lapply(model$data[model$factors], levels)), stringsAsFactors = FALSE))
  grid <- grid[model$factors]
  key <- function(table) do.call(paste, c(unname(lapply(table[model$factors], as.character)), sep = "\r"))
  values <- split(model$data[[model$response]], factor(key(model$data), levels = key(grid)))
  n <- lengths(values)
  mean <- vapply(values, function(x) if (length(x)) mean(x) else NA_real_, 0)
  sd <- vapply(values, sd, 0)
  table <- cbind(setNames(grid, true_name(model, model$factors)), n = n, mean = mean, sd = sd)
  if (with_limits) {
    reach <- suppressWarnings(qt(1 - plan$alpha / 2, n - 1)) * sd / sqrt(n)
    table <- cbind(table, "lower limit" = mean - reach, "upper limit" = mean + reach)
  }
  keep("Raw means", table)
}

look_at_cells <- function(model) {
  if (length(model$factors) == 0) return()
  counts <- table(model$data[model$factors])
  if (any(counts == 0)) {
    warn(sum(counts == 0),
        " combination(s) of levels have no rows, so type II and type III tests have different hypotheses")
  } else if (length(unique(counts)) > 1 && length(model$factors) > 1) {
    warn("the design is unbalanced (cells have ", min(counts), " to ", max(counts),
        " rows): raw means mix the effects of several factors")
  }
  if (min(counts) < 10 && min(counts) > 0) warn("the smallest cell has ", min(counts),
      " rows, so tests depend on normal residuals")
}
look_at_residuals <- function(residuals) {
  z <- (residuals - mean(residuals)) / sqrt(mean((residuals - mean(residuals))^2))
  skewness <- mean(z^3)
  kurtosis <- mean(z^4) - 3
  if (is.finite(skewness) && (abs(skewness) > 1 || abs(kurtosis) > 2))
    warn(sprintf("residuals are not normally distributed (skewness %.2f, excess kurtosis %.2f)", skewness, kurtosis))
}
compare_types <- function(model, two, three, alpha) {
  for (i in seq_along(two)) if (!anyNA(c(two[i], three[i])) && (two[i] < alpha) != (three[i] < alpha))
    warn(true_name(model, model$terms[i]), ": tests of type II and type III disagree (", shown_p(two[i]), " and ",
        shown_p(three[i]),
         "); marginal means and pairs correspond to type III")
}
sentences <- function(model, start, p, eta, means, alpha)
  paste(c(start, vapply(seq_along(model$terms), function(i) term_sentence(model, model$terms[i], p[i], eta[i, ],
      means, alpha), "")), collapse = " ")

# --- the models -----------------------------------------------------------------------------------------------------

linear <- function(model, plan) {
  model$fit <- lm(model$fixed, data = model$data)
  model$scale <- "difference"
  model$sd <- sigma(model$fit)
  n <- nrow(model$data)
  start <- sprintf("Analysis of variance of %s (%d rows).", true_name(model, model$response), n)
  if (df.residual(model$fit) == 0) stop("there are no more rows than parameters of the model")
  if (model$sd^2 <= 1e-20 * var(model$data[[model$response]])) stop("there is no spread around the model's values")
  if (length(model$terms) == 0) return(start)
  anova_table <- function(tests) {
    f <- tests[model$terms, "F value"]
    df <- tests[model$terms, "Df"]
    residual <- tests["Residuals", "Df"]
    table <- data.frame(term = true_name(model, model$terms), df = df, "sum of squares" = tests[model$terms,
        "Sum Sq"], F = f,
                        "p-value" = tests[model$terms, "Pr(>F)"], check.names = FALSE)
    list(table = with_eta(table, f, df, rep(residual, length(f)), plan$alpha), residual = residual,
        squares = tests["Residuals", "Sum Sq"])
  }
  two <- anova_table(car::Anova(model$fit, type = 2, singular.ok = TRUE))
  set_tests("F", two$table$term, two$table$df, two$residual, two$table$F, two$table[["p-value"]])
  keep("Analysis of variance (type II)", rbind(two$table, NA_row(two$table, "residuals", two$residual, two$squares)),
      blank = 1)
  ways <- c("one-way", "two-way", "three-way", "four-way")
  k <- length(model$factors)
  method(paste0(if (length(model$covariates)) "analysis of covariance" else paste(c(ways, paste0(k, "-factor"))[min(k,
      5)], "analysis of variance"),
                if (length(model$terms) > 1) " (type II sums of squares)"))
  method(paste(per_cent(1 - 2 * plan$alpha), "intervals of partial eta squared from the non-central F distribution"))
  if (k > 0 && length(unique(table(model$data[model$factors]))) > 1 && length(model$terms) > 1 &&
      !anyNA(coef(model$fit))) {
    sums <- lapply(setNames(model$factors, model$factors), function(x) "contr.sum")
    three <- anova_table(car::Anova(lm(model$fixed, data = model$data, contrasts = sums), type = 3))
    keep("Analysis of variance (type III)", three$table[1:5])
    compare_types(model, two$table[["p-value"]], three$table[["p-value"]], plan$alpha)
  }
  if (k == 1 && length(model$terms) == 1 && all(table(model$data[[model$factors]]) > 1)) {
    welch <- oneway.test(model$fixed, data = model$data)
    keep("Test that does not assume equal variances (Welch)",
         data.frame(term = two$table$term, F = unname(welch$statistic), "p-value" = welch$p.value, check.names = FALSE))
    ranks <- kruskal.test(model$fixed, data = model$data)
    keep("Rank test (Kruskal-Wallis)", data.frame(term = two$table$term, "chi-squared" = unname(ranks$statistic),
                                                  "p-value" = ranks$p.value, check.names = FALSE))
  }
  look_at_cells(model)
  look_at_residuals(residuals(model$fit))
  far <- car::outlierTest(model$fit, cutoff = 0.001)
  if (isTRUE(far$signif) && !model$is_binary)
    warn("the value ", shown(model$data[names(far$rstudent)[1], model$response]), " is far from the others: ",
         sprintf("%.1f",
             abs(far$rstudent[1])),
             " standard deviations from what the model says without it; see whether it is an error")
  raw_means(model, plan, TRUE)
  means <- means_of(model, plan, length(model$variables) > 1)
  slopes_of(model, plan)
  comparisons <- compare(model, plan)
  paste0(sentences(model, start, two$table[["p-value"]], as.matrix(two$table[6:8]), means, plan$alpha), comparisons)
}
NA_row <- function(table, name, df, squares) {
  row <- table[1, ]
  row[] <- NA
  row[[1]] <- name
  row$df <- df
  row[["sum of squares"]] <- squares
  row
}

mixed <- function(model, plan) {
  # Small variances need more digits than the default gives.
  model$fit <- lmer(model$formula, data = model$data, control = lmerControl(optimizer = "bobyqa",
      optCtrl = list(rhoend = 1e-9)))
  emm_options(lmer.df = "satterthwaite", lmerTest.limit = nrow(model$data), pbkrtest.limit = 0)
  variances <- as.data.frame(VarCorr(model$fit))
  variances <- variances[is.na(variances$var2), ]
  model$scale <- "difference"
  model$sd <- sqrt(sum(variances$vcov))  # of a single row
  group <- variances$grp != "Residual"
  sizes <- ngrps(model$fit)[variances$grp[group]]
  start <- sprintf("Mixed model of %s (%d rows in %s groups).", true_name(model, model$response), nrow(model$data),
      sizes[1])
  tests_by <- function(type) {
    tests <- anova(model$fit, type = type)[model$terms, , drop = FALSE]
    f <- tests[["F value"]]
    table <- data.frame(term = true_name(model, model$terms), df = tests$NumDF, "residual df" = sprintf("%.1f",
        tests$DenDF), F = f,
                        "p-value" = tests[["Pr(>F)"]], check.names = FALSE)
    list(table = with_eta(table, f, tests$NumDF, tests$DenDF, plan$alpha), residual = tests$DenDF)
  }
  if (length(model$terms) > 0) {
    two <- tests_by(2)
    set_tests("F", two$table$term, two$table$df, two$residual, two$table$F, two$table[["p-value"]])
    keep("Tests of the fixed effects (type II, Satterthwaite)", two$table)
    if (length(model$terms) > 1) {
      three <- tests_by(3)
      if (any(abs(two$table[["p-value"]] - three$table[["p-value"]]) > 1e-6, na.rm = TRUE))
        keep("Tests of the fixed effects (type III, Satterthwaite)", three$table)
      compare_types(model, two$table[["p-value"]], three$table[["p-value"]], plan$alpha)
    }
  }
  method("linear mixed model (REML) with Satterthwaite's degrees of freedom", "kuznetsova2017")
  if (length(model$terms) > 0)
    method(paste(per_cent(1 - 2 * plan$alpha), "intervals of partial eta squared from the non-central F distribution"))
  correlation <- variances$vcov / sum(variances$vcov)
  keep("Variances and intraclass correlations",
       data.frame("rows with the same" = c(true_name(model, variances$grp[group]), "(residual)"), groups = c(sizes, NA),
                  variance = c(variances$vcov[group],
                      variances$vcov[!group]), "intraclass correlation" = c(correlation[group], NA),
                  check.names = FALSE), blank = 1)
  for (i in which(group)) {
    if (variances$vcov[i] == 0)
      warn("the variance of ", true_name(model, variances$grp[i]),
          " is estimated as 0, so the tests treat rows as independent of it")
    if (sizes[variances$grp[i]] < 10)
      warn("there are only ", sizes[variances$grp[i]], " different values of ", true_name(model, variances$grp[i]),
           ", so the variance and the intraclass correlation are very uncertain")
  }
  look_at_cells(model)
  raw_means(model, plan, FALSE)
  means <- means_of(model, plan, TRUE)
  slopes_of(model, plan)
  comparisons <- compare(model, plan)
  likeness <- sprintf(" The intraclass correlation of rows with the same %s is %.2f.", true_name(model,
      variances$grp[group]), correlation[group])
  terms <- if (length(model$terms)) sentences(model, start, two$table[["p-value"]], as.matrix(two$table[6:8]), means,
      plan$alpha) else start
  paste0(terms, paste(likeness, collapse = ""), comparisons)
}

# Ratings, of which only the order counts.
ratings <- function(model, plan) {
  values <- model$data[[model$response]]
  model$data[[model$response]] <- factor(values, ordered = TRUE)
  fit_with <- function(formula) {
    if (model$is_mixed) ordinal::clmm(formula, data = model$data, Hess = TRUE,
        nAGQ = if (length(lme4::findbars(formula)) == 1) 7 else 1)
    else ordinal::clm(formula, data = model$data, control = ordinal::clm.control(gradTol = 1e-9))
  }
  model$fit <- fit_with(model$formula)
  model$fit$call$formula <- model$formula
  model$fit$call$data <- quote(model$data)
  model$scale <- "odds ratio"
  model$sd <- NA
  model$mode <- list(mode = "latent")
  start <- sprintf("Proportional odds model of %s (%d rows).", true_name(model, model$response), nrow(model$data))
  if (length(model$terms) == 0) return(start)
  tests <- likelihood_ratios(model, fit_with)
  keep_ratios(model, "Likelihood-ratio tests (proportional odds model, type II)", tests)
  method(paste0("proportional odds model", if (model$is_mixed) " with random intercepts",
      " with likelihood-ratio tests"), "mccullagh1980")
  if (!model$is_mixed) {
    nominal <- suppressWarnings(try(ordinal::nominal_test(model$fit), silent = TRUE))
    if (!inherits(nominal, "try-error") && any(nominal[["Pr(>Chi)"]] < plan$alpha, na.rm = TRUE))
      warn("odds ratios differ between steps of the scale, so one odds ratio per level is a summary only")
  }
  comparisons <- compare(model, plan)
  for (factor in model$factors) {
    shares <- prop.table(table(model$data[[factor]], values), 1)
    keep(paste("How often each rating was given, by", true_name(model, factor)),
         cbind(setNames(data.frame(rownames(shares)), true_name(model, factor)), as.data.frame.matrix(shares)),
         kinds = c("text", rep("fraction", ncol(shares))))
  }
  eta <- matrix(NA_real_, length(model$terms), 3)
  paste0(sentences(model, start, tests$p, eta, list(), plan$alpha),
      " An odds ratio above 1 stands for higher ratings.", comparisons)
}

# Counts, beside the linear model: regressions that allow for their spread, and survival where some were cut off.
counts <- function(model, plan) {
  model$scale <- "ratio"
  model$sd <- NA
  model$about <- "Ratios of means: "
  cut <- plan$observed != ""
  if (cut) {
    observed <- model$data[[model$plain[plan$observed]]]
    observed <- if (is.numeric(observed)) observed != 0 else tolower(as.character(observed)) == "true"
    if (!all(observed))
      warn(sum(!observed), " of ", nrow(model$data),
          " rows were stopped before they finished, so their counts are lower bounds; only ",
           "the Kaplan-Meier estimates and log-rank tests allow for that")
    if (all(model$data[[model$response]] > 0)) survival_of(model, plan, observed)
    if (!all(observed)) return()
  }
  if (model$is_mixed) {
    fit_with <- function(formula) lme4::glmer(formula, model$data, poisson,
        control = lme4::glmerControl(optimizer = "bobyqa"))
    model$fit <- fit_with(model$formula)
    spread <- sum(residuals(model$fit, "pearson")^2) / df.residual(model$fit)
    if (spread > 1.5)
      warn(sprintf("counts vary %.1f times as much as Poisson's, so tests of their regression find too much", spread))
    keep_ratios(model, "Likelihood-ratio tests of the Poisson regression (type II)", likelihood_ratios(model, fit_with))
    method("Poisson regression with random intercepts and likelihood-ratio tests", "bates2015")
    compare(model, plan, contrasts = FALSE)
    return()
  }
  poisson <- glm(model$fixed, stats::poisson, data = model$data)
  dispersion <- sum(residuals(poisson, "pearson")^2) / df.residual(poisson)
  control <- glm.control(epsilon = 1e-12, maxit = 200)
  fit_with <- function(formula) suppressWarnings(MASS::glm.nb(formula, model$data, control = control))
  negative <- if (dispersion > 1) tryCatch(fit_with(model$fixed), error = function(e) NULL)
  # Without an end to theta it is Poisson's model.
  if (!is.null(negative) && is.finite(negative$theta) && negative$theta < 1e5) {
    model$fit <- negative
    keep_ratios(model, sprintf("Likelihood-ratio tests of the negative binomial regression (type II, theta %.2f)",
        negative$theta),
                likelihood_ratios(model, fit_with))
    method("negative binomial regression with likelihood-ratio tests")
  } else {
    model$fit <- glm(model$fixed, quasipoisson, data = model$data, control = control)
    model$mode <- list(df = df.residual(model$fit))
    tests <- car::Anova(model$fit, type = 2, test.statistic = "F")
    keep(sprintf("F tests of the quasi-Poisson regression (type II, dispersion %.2f)", dispersion),
         data.frame(term = true_name(model, model$terms), df = tests[model$terms, "Df"], F = tests[model$terms,
             "F value"],
                    "p-value" = tests[model$terms, "Pr(>F)"], check.names = FALSE))
    method("quasi-Poisson regression with F tests", "mccullagh1989")
  }
  compare(model, plan, contrasts = FALSE)
}

survival_of <- function(model, plan, observed) {
  time <- survival::Surv(model$data[[model$response]], observed)
  if (!model$is_mixed) {
    rows <- lapply(model$factors, function(factor) {
      group <- model$data[[factor]]
      others <- setdiff(model$factors, factor)
      cell <- if (length(others) > 0) interaction(model$data[others], drop = TRUE)
      strata <- survival::strata
      test <- if (length(others) == 0) survival::survdiff(time ~ group)
              else survival::survdiff(time ~ group + strata(cell))
      # Groups that nobody was left of at the first event count for nothing.
      df <- sum(rowSums(as.matrix(test$exp)) > 0) - 1
      data.frame(factor = true_name(model, factor), "chi-squared" = test$chisq, df = df,
                 "p-value" = pchisq(test$chisq, df, lower.tail = FALSE), check.names = FALSE)
    })
    keep(if (length(model$factors) > 1) "Log-rank tests, stratified by the other factors" else "Log-rank test",
        do.call(rbind, rows))
    method(if (length(model$factors) > 1) "log-rank tests stratified by the other factors" else "the log-rank test")
  }
  rows <- lapply(model$factors, function(factor) {
    each <- lapply(levels(model$data[[factor]]), function(level) {
      at <- model$data[[factor]] == level
      curve <- survival::survfit(time[at] ~ 1)
      data.frame(group = paste(true_name(model, factor), level), n = sum(at), censored = sum(!observed[at]),
                 median = unname(summary(curve)$table["median"]))
    })
    do.call(rbind, each)
  })
  keep(paste0("Median ", true_name(model, model$response), " (Kaplan-Meier)"), do.call(rbind, rows))
  method("Kaplan-Meier estimates", "kaplan1958")
}

# --- all of it ------------------------------------------------------------------------------------------------------

analyse <- function(data_file, plan_file) {
  plan <- read_plan(plan_file)
  model <- add_intercepts(prepare(read_table(data_file), plan), plan)
  sentence <- if (model$kind == "ordinal") ratings(model, plan)
              else if (model$is_mixed) mixed(model, plan)
              else linear(model, plan)
  if (model$kind == "count" && length(model$factors) > 0) counts(model, plan)
  tests <- found$tests
  results <- ""
  if (!is.null(tests)) {
    apa <- function(p) if (p < 0.0005) "p < .001" else sub("0\\.", ".", sprintf("p = %.3f", p))
    each <- vapply(which(!is.na(tests$tests$p)), function(i) with(tests$tests[i, ],
        sprintf("%s %s significant, %s(%s) = %.2f, %s.",
        if (grepl(":", subject)) paste("The interaction of", listed(strsplit(subject,
            ":")[[1]])) else paste("The effect of", subject),
        if (p < plan$alpha) "was" else "was not", tests$statistic, paste(c(df,
            if (!is.na(residual_df)) format(residual_df, digits = 4)), collapse = ", "),
        statistic, apa(p))), "")
    results <- paste0(model$shown, " (", found$methods[[1]]$text, "). ", paste(each, collapse = " "))
  }
  name <- true_name(model, model$response)
  c(list(id = name, title = model$shown, question = paste0("Does ", name, " depend on the factors of the model?"),
         model = model$shown, sentence = sentence, results = results, notes = as.list(found$notes),
         warnings = as.list(found$warnings)),
    found[c("tests", "means", "tables")], list(methods = unique(found$methods)))
}

arguments <- commandArgs(trailingOnly = TRUE)
if (length(arguments) != 2) stop("usage: Rscript analysis.R DATA.csv PLAN.json", call. = FALSE)
options(warn = 1)
result <- tryCatch(withCallingHandlers(analyse(arguments[1], arguments[2]), warning = function(w) {
  warn("R says: ", gsub("\\s+", " ", conditionMessage(w)))
  invokeRestart("muffleWarning")
}), error = function(e) list(error = gsub("\\s+", " ", conditionMessage(e))))
cat(jsonlite::toJSON(result, auto_unbox = TRUE, digits = NA, na = "null", null = "null"), "\n")
if (!is.null(result$error)) quit(status = 2)
