# Writes models.json, the reference values of survival_test.
#
#   Rscript libs/analysis/tests/reference/make_reference_models.R libs/analysis/tests/reference/models.json
#
# Needs R >= 4.1 with survival (Debian: r-recommended). Data sets are drawn here with fixed seeds and stored with the
# results, so that neither the build nor the tests need R.

library(survival)

RNGkind("Mersenne-Twister", "Inversion", "Rejection")

folder <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
source(file.path(folder, "common.R"))

# ---- survival ----

survival_case <- function(name, time, event, group = NULL, strata = NULL) {
  # timefix = FALSE: times are equal if they are, not if they differ by 1e-8. survdiff stops at that option, but needs
  # no more than the order of the times.
  curve <- survfit(Surv(time, event) ~ 1, timefix = FALSE)
  wide <- survfit(Surv(time, event) ~ 1, conf.int = 0.8, timefix = FALSE)
  out <- list(name = one(name), time = time, event = event,
              curve = list(time = curve$time, at_risk = curve$n.risk, events = curve$n.event, survival = curve$surv,
                           low = curve$lower, high = curve$upper, low80 = wide$lower, high80 = wide$upper,
                           median = one(unname(summary(curve)$table["median"]))))
  if (!is.null(group)) {
    fit <- survdiff(Surv(rank(time), event) ~ group)
    df <- sum(fit$exp > 0) - 1
    out$groups <- factor_json("group", group)
    out$log_rank <- list(statistic = one(fit$chisq), df = one(df),
                         p = one(pchisq(fit$chisq, df, lower.tail = FALSE)))
  }
  if (!is.null(strata)) {
    fit <- survdiff(Surv(rank(time), event) ~ group + strata(strata))
    df <- sum(rowSums(as.matrix(fit$exp)) > 0) - 1
    out$strata <- factor_json("strata", strata)
    out$stratified <- list(statistic = one(fit$chisq), df = one(df),
                           p = one(pchisq(fit$chisq, df, lower.tail = FALSE)))
  }
  out
}

letters_factor <- function(k, n, shuffle = TRUE) {
  codes <- rep_len(seq_len(k), n)
  factor(letters[if (shuffle) sample(codes) else codes], levels = letters[seq_len(k)])
}

survival_cases <- function() {
  set.seed(1)
  n <- 60
  distinct <- survival_case("no ties", rexp(n, 0.1), runif(n) < 0.7, letters_factor(2, n))
  n <- 200
  group <- letters_factor(4, n)
  time <- pmin(1 + rgeom(n, c(0.1, 0.14, 0.2, 0.12)[codes(group) + 1]), 20)
  ties <- survival_case("many ties, cut at a cap", time, time < 20, group, letters_factor(3, n))
  heavy <- survival_case("heavy censoring", rexp(n), runif(n) < 0.05, group, letters_factor(2, n))
  none <- survival_case("no events", c(3, 5, 5, 8), rep(FALSE, 4))
  at_once <- survival_case("all at once", rep(4, 7), rep(TRUE, 7))
  half <- survival_case("exactly one half", c(1, 2, 3, 4), c(TRUE, TRUE, FALSE, TRUE), factor(c("a", "b", "a", "b")))
  flat <- survival_case("one half to the end", c(1, 2, 3, 4), c(TRUE, TRUE, FALSE, FALSE), factor(c("a", "b", "b", "a")))
  early <- survival_case("a group that leaves before the first event", c(1, 1, 2, 3, 4, 5, 6, 7),
                         c(FALSE, FALSE, TRUE, TRUE, FALSE, TRUE, TRUE, TRUE),
                         factor(c("a", "a", "b", "c", "b", "c", "c", "b")))
  n <- 300
  group <- factor(sample(c("x", "y", "z"), n, TRUE, c(0.9, 0.07, 0.03)), levels = c("x", "y", "z"))
  strata <- factor(sample(letters[1:6], n, TRUE), levels = letters[1:6])
  time <- rexp(n, ifelse(group == "x", 1, 1.6) * codes(strata) + 1) * 1e-6
  unbalanced <- survival_case("unbalanced groups and strata, tiny times", time, runif(n) < 0.8, group, strata)
  list(distinct, ties, heavy, none, at_once, half, flat, early, unbalanced)
}

arguments <- commandArgs(trailingOnly = TRUE)
stopifnot(length(arguments) == 1)
json <- as_json(list(made_by = one(paste(R.version.string, "survival", packageVersion("survival"))),
                     survival = survival_cases()))
writeLines(json, arguments)
