# Writes models.json, the reference values of survival_test, count_model_test and resampling_test.
#
#   Rscript libs/stats/tests/reference/make_reference_models.R libs/stats/tests/reference/models.json
#
# Needs R >= 4.1 with survival and MASS (Debian: r-recommended). Data sets are drawn here with fixed seeds and stored
# with the results, so that neither the build nor the tests need R. What R has no function for (the aligned rank
# transform) is computed here from its definition, with R's lm and drop1.

library(survival)
library(MASS)

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

# ---- counts ----

terms_of <- function(fs) if (length(fs)) names(fs) else "1"
log_likelihood <- function(fit) as.numeric(logLik(fit))

wald <- function(fit) {
  s <- coef(summary(fit, dispersion = 1))
  list(coefficients = unname(s[, 1]), standard_errors = unname(s[, 2]), z = unname(s[, 3]), p = unname(s[, 4]))
}

negative_binomial <- function(y, fs) {
  d <- as.data.frame(c(list(y = y), fs))
  glm.nb(reformulate(terms_of(fs), "y"), d, control = glm.control(epsilon = 1e-12, maxit = 200))
}
poisson_fit <- function(y, fs) {
  d <- as.data.frame(c(list(y = y), fs))
  glm(reformulate(terms_of(fs), "y"), poisson, d, control = glm.control(epsilon = 1e-13, maxit = 200))
}

count_case <- function(name, y, fs, model) {
  p <- poisson_fit(y, fs)
  fit <- if (model == "poisson") p else negative_binomial(y, fs)
  refit <- if (model == "poisson") poisson_fit else negative_binomial
  tests <- lapply(as.character(names(fs)), function(f) {
    lr <- 2 * (log_likelihood(fit) - log_likelihood(refit(y, fs[names(fs) != f])))
    df <- nlevels(fs[[f]]) - 1
    list(statistic = one(lr), df = one(df), p = one(pchisq(lr, df, lower.tail = FALSE)))
  })
  c(list(name = one(name), counts = y, factors = factors_json(fs),
         theta = one(if (model == "poisson") NA else fit$theta), log_likelihood = one(log_likelihood(fit)),
         dispersion = one(sum(residuals(p, "pearson")^2) / p$df.residual), tests = tests), wald(fit))
}

count_cases <- function() {
  set.seed(2)
  n <- 240
  fs <- list(strategy = letters_factor(4, n), composition = letters_factor(3, n))
  mu <- exp(1.5 + 0.2 * codes(fs$strategy) - 0.3 * (codes(fs$composition) == 1))
  over <- count_case("overdispersed", rnbinom(n, size = 2, mu = mu), fs, "negative binomial")
  slightly <- count_case("slightly overdispersed", rnbinom(n, size = 30, mu = 2 * mu), fs, "negative binomial")
  periods <- pmax(4, round(rnorm(n, 7.7 + 0.4 * codes(fs$strategy), 1.5)))
  under <- count_case("underdispersed", periods, fs, "poisson")
  one_factor <- count_case("one factor", rnbinom(n, size = 0.3, mu = mu), fs["strategy"], "negative binomial")
  n <- 150
  fs <- list(a = factor(sample(letters[1:3], n, TRUE, c(0.8, 0.15, 0.05)), levels = letters[1:3]),
             b = factor(sample(letters[1:2], n, TRUE, c(0.3, 0.7)), levels = letters[1:2]),
             c = factor(sample(letters[1:5], n, TRUE), levels = letters[1:5]))
  mu <- exp(0.5 + 0.5 * codes(fs$a) - 0.7 * codes(fs$b))
  unbalanced <- count_case("unbalanced, three factors", rnbinom(n, size = 1.5, mu = mu), fs, "negative binomial")
  large <- count_case("large counts", rnbinom(n, size = 4, mu = 2000 * mu), fs, "negative binomial")
  rare <- count_case("mostly zeros", rnbinom(n, size = 0.5, mu = mu / 2), fs["b"], "negative binomial")
  alone <- count_case("no factors", rnbinom(n, size = 3, mu = 5), list(), "negative binomial")
  zero_cell <- local({
    d <- expand.grid(a = factor(letters[1:2]), b = factor(letters[1:3]), copy = 1:4)
    y <- c(1, 2, 0, 1, 3, 2, 2, 1, 0, 2, 2, 1, 1, 2, 0, 1, 1, 2, 2, 1, 0, 1, 3, 1)
    count_case("a cell with only zeros", y, list(a = d$a, b = d$b), "poisson")
  })
  list(over, slightly, under, one_factor, unbalanced, large, rare, alone, zero_cell)
}

# ---- aligned rank transform ----

# The effect of `term` from the table of cells' means: the alternating sum over its subsets of marginal means.
effect_of <- function(term, means) {
  effect <- array(0, dim(means))
  for (size in 0:length(term)) {
    for (set in if (size == 0) list(integer(0)) else combn(length(term), size, simplify = FALSE)) {
      kept <- term[set]
      margin <- if (length(kept)) apply(means, kept, mean) else mean(means)
      spread <- if (length(kept)) sweep(array(0, dim(means)), kept, margin, "+") else array(margin, dim(means))
      effect <- effect + (-1)^(length(term) - size) * spread
    }
  }
  effect
}

aligned_case <- function(name, y, fs) {
  d <- data.frame(fs)
  contrasts <- setNames(rep(list("contr.sum"), length(fs)), names(fs))
  means <- tapply(y, fs, mean)
  cell <- as.matrix(sapply(fs, as.integer))
  residual <- y - means[cell]
  sets <- unlist(lapply(seq_along(fs), function(k) combn(length(fs), k, simplify = FALSE)), recursive = FALSE)
  rows <- lapply(sets, function(term) {
    aligned <- residual + effect_of(term, means)[cell]
    d$r <- rank(round(aligned / max(abs(y)), 9))
    fit <- lm(reformulate(paste(names(fs), collapse = "*"), "r"), d, contrasts = contrasts)
    # drop1 wants to keep hierarchies; with all columns of the design at hand, scope ~ . does not.
    table <- drop1(fit, . ~ ., test = "F")
    label <- paste(names(fs)[term], collapse = ":")
    list(name = one(label), df = one(table[label, "Df"]), sum_of_squares = one(table[label, "Sum of Sq"]),
         f = one(table[label, "F value"]), p = one(table[label, "Pr(>F)"]),
         aligned = aligned)
  })
  list(name = one(name), response = y, factors = factors_json(fs), terms = rows)
}

aligned_cases <- function() {
  set.seed(3)
  grid <- function(...) { d <- expand.grid(...); d[] <- lapply(d, factor); d }
  d <- grid(a = letters[1:3], b = letters[1:2], copy = 1:8)
  balanced <- aligned_case("balanced", rlnorm(48, 0.4 * codes(d$a)) + codes(d$b), list(a = d$a, b = d$b))
  counts <- aligned_case("counts with ties", rpois(48, 3 + codes(d$a) * codes(d$b)), list(a = d$a, b = d$b))
  keep <- sort(c(1:6, sample(7:48, 25)))
  unbalanced <- aligned_case("unbalanced", (rcauchy(48) + codes(d$a))[keep],
                             list(a = d$a[keep], b = d$b[keep]))
  d <- grid(a = letters[1:2], b = letters[1:3], c = letters[1:2], copy = 1:3)
  three <- aligned_case("three factors", rexp(36, 1 + codes(d$b)), list(a = d$a, b = d$b, c = d$c))
  d <- grid(a = letters[1:2], b = letters[1:2], c = letters[1:3], d = letters[1:2], copy = 1:2)
  keep <- c(1:24, 24 + sort(sample(24, 15)))
  four <- aligned_case("four factors, unbalanced", (rt(48, 3) * 1e8)[keep],
                       list(a = d$a[keep], b = d$b[keep], c = d$c[keep], d = d$d[keep]))
  d <- grid(a = letters[1:4], copy = 1:5)
  single <- aligned_case("one factor", rlnorm(20), list(a = d$a))
  list(balanced, counts, unbalanced, three, four, single)
}

arguments <- commandArgs(trailingOnly = TRUE)
stopifnot(length(arguments) == 1)
json <- as_json(list(made_by = one(paste(R.version.string, "survival", packageVersion("survival"), "MASS",
                                         packageVersion("MASS"))),
                     survival = survival_cases(), counts = count_cases(), aligned = aligned_cases()))
writeLines(json, arguments)
