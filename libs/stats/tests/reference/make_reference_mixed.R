# Writes mixed.json, the reference values of mixed_model_test.
#
#   Rscript libs/stats/tests/reference/make_reference_mixed.R libs/stats/tests/reference/mixed.json
#
# Needs R >= 4.1 with lme4, lmerTest and numDeriv (Debian: r-cran-lme4, r-cran-lmertest). Data sets are drawn here with
# fixed seeds and stored with the results, so that neither the build nor the tests need R.

suppressPackageStartupMessages({
  library(lme4)
  library(lmerTest)
  library(numDeriv)
})

RNGkind("Mersenne-Twister", "Inversion", "Rejection")

folder <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
source(file.path(folder, "common.R"))

# ---- fits ----

source(file.path(folder, "lmer.R"))

# The interval of the intraclass correlation of a single random intercept, by the profile of theta.
profile_icc <- function(f, level = 0.9) {
  limit <- f$value + qchisq(level, 1)
  excess <- function(theta) f$devfun(theta) - limit
  icc <- function(theta) theta^2 / (1 + theta^2)
  low <- if (f$theta > 0 && excess(0) > 0) uniroot(excess, c(0, f$theta), tol = 1e-14)$root else 0
  high <- uniroot(excess, c(f$theta, f$theta + 10), extendInt = "upX", tol = 1e-14)$root
  c(icc(low), icc(high))
}

# With several, Wald's interval of the log odds of a share; the covariance of theta is lmerTest's.
wald_icc <- function(theta, vcov_theta, k, level = 0.9) {
  tau <- theta^2
  rest <- 1 + sum(tau) - tau[k]
  slope <- -2 * theta / rest
  slope[k] <- 2 / theta[k]
  odds <- log(tau[k] / rest)
  reach <- qnorm(0.5 + level / 2) * sqrt(drop(slope %*% vcov_theta %*% slope))
  plogis(odds + c(-1, 1) * reach)
}

# R is given y - centre, so that its deviance keeps all digits.
mixed_case <- function(name, y, factors, terms, groups, reml = TRUE, centre = 0) {
  d <- as.data.frame(c(list(y = y - centre), factors, groups))
  fixed <- if (length(terms)) paste(terms, collapse = " + ") else "1"
  random <- paste0("(1 | ", names(groups), ")")
  formula <- as.formula(paste("y ~", fixed, "+", paste(random, collapse = " + ")))
  f <- fit(formula, d, reml)
  model <- lmerTest:::as_lmerModLT(f$model, f$devfun)
  # lme4 orders terms by their number of levels.
  order <- match(names(groups), names(getME(model, "flist")))
  theta <- f$theta[order]
  set.seed(99)
  p <- length(fixef(model))
  combinations <- rbind(diag(p), matrix(round(rnorm(3 * p), 2), 3))
  tests <- apply(combinations, 1, function(l) {
    t <- contest1D(model, l)
    list(weights = l, estimate = one(t$Estimate + l[1] * centre), se = one(t$`Std. Error`), df = one(t$df), p = one(t$`Pr(>|t|)`))
  })
  anova_rows <- function(type) {
    if (!length(terms)) return(list())
    table <- suppressMessages(lmerTest:::single_anova(model, type = type))
    lapply(seq_len(nrow(table)), function(i)
      list(name = one(rownames(table)[i]), df = one(table$NumDF[i]), denominator = one(table$DenDF[i]),
           f = one(table$`F value`[i]), p = one(table$`Pr(>F)`[i])))
  }
  log_likelihood <- as.numeric(logLik(f$model))
  lr <- vapply(seq_along(groups), function(k) {
    without <- if (length(groups) == 1) {
      as.numeric(logLik(lm(as.formula(paste("y ~", fixed)), d), REML = reml))
    } else {
      reduced <- as.formula(paste("y ~", fixed, "+", paste(random[-k], collapse = " + ")))
      as.numeric(logLik(fit(reduced, d, reml)$model))
    }
    2 * (log_likelihood - without)
  }, 0)
  vcov_theta <- model@vcov_varpar[order, order, drop = FALSE]
  intervals <- lapply(seq_along(groups), function(k) {
    if (length(groups) == 1) profile_icc(f) else if (theta[k] > 0) wald_icc(theta, vcov_theta, k) else numeric(0)
  })
  list(name = one(name), y = y, factors = unname(Map(factor_json, names(factors), factors)),
       terms = lapply(strsplit(terms, ":"), function(t) match(t, names(factors)) - 1),
       groups = unname(Map(factor_json, names(groups), groups)), reml = one(reml),
       sigma = one(sigma(model)), variances = (theta * sigma(model))^2, log_likelihood = one(log_likelihood),
       combinations = unname(tests), type2 = anova_rows("2"), type3 = anova_rows("3"),
       likelihood_ratios = lr, intervals = intervals)
}

# ---- data ----

level_factor <- function(prefix, codes) factor(paste0(prefix, codes), levels = unique(paste0(prefix, sort(codes))))
effect <- function(g, sd) rnorm(nlevels(g), 0, sd)[g]

cases <- function() {
  set.seed(11)
  # Balanced: teams of 3, factors of teams.
  team <- level_factor("t", rep(1:24, each = 3))
  s <- level_factor("s", rep(rep(1:3, each = 8), each = 3))
  c2 <- level_factor("c", rep(rep(1:2, 12), each = 3))
  y <- 0.5 + 0.2 * codes(s) + effect(team, 0.3) + rnorm(72, 0, 0.4)
  balanced <- mixed_case("balanced, teams of three", y, list(strategy = s, composition = c2),
                         c("strategy", "composition", "strategy:composition"), list(team = team))
  y <- 0.5 + 0.1 * codes(c2) + effect(team, 0.3) + rnorm(72, 0, 0.4)
  type <- level_factor("k", rep(1:3, 24))
  split_plot <- mixed_case("factors between and within teams", y, list(strategy = s, type = type),
                           c("strategy", "type", "strategy:type"), list(team = team))

  # Unbalanced sizes, levels confounded.
  n <- 90
  g <- factor(sample(paste0("g", 1:25), n, TRUE, (1:25)^1.5))
  a <- drawn("a", 3, n)
  b <- drawn("b", 2, n)
  unbalanced <- mixed_case("unbalanced", 3 + codes(a) * 0.4 + effect(g, 1) + rnorm(n), list(a = a, b = b),
                           c("a", "b", "a:b"), list(g = g))
  additive <- mixed_case("unbalanced, additive", 3 + codes(a) * 0.4 + effect(g, 0.8) + rnorm(n), list(a = a, b = b),
                         c("a", "b"), list(g = g))
  maximum_likelihood <- mixed_case("maximum likelihood", 3 + codes(b) * 0.4 + effect(g, 0.8) + rnorm(n),
                                   list(a = a, b = b), c("a", "b", "a:b"), list(g = g), reml = FALSE)
  alone <- mixed_case("mean alone", 10 + effect(g, 2) + rnorm(n, 0, 1.5), list(), character(0), list(g = g))
  singular <- mixed_case("zero group variance", rnorm(n) - 0.8 * ave(rnorm(n), g), list(a = a, b = b),
                         c("a", "b", "a:b"), list(g = factor(rep_len(paste0("z", 1:15), n))))
  stopifnot(singular$variances == 0)

  # Most groups have one row.
  g <- factor(paste0("g", c(1:30, 1:8)))
  a <- drawn("a", 2, 38)
  lonely <- mixed_case("most groups with one row", 1 + 0.5 * codes(a) + effect(g, 1) + rnorm(38, 0, 0.5), list(a = a),
                       "a", list(g = g))

  # Nested: members within teams, several periods.
  d <- expand.grid(period = 1:4, member = 1:3, team = 1:14)
  d <- d[-sample(nrow(d), 20), ]
  team <- level_factor("t", d$team)
  member <- factor(paste0("t", d$team, ":", d$member))
  s <- level_factor("s", 1 + d$team %% 2)
  period <- level_factor("p", d$period)
  y <- 0.3 * d$period + 0.5 * codes(s) + effect(team, 0.6) + effect(member, 0.5) + rnorm(nrow(d), 0, 0.7)
  nested <- mixed_case("nested", y, list(strategy = s, period = period), c("strategy", "period", "strategy:period"),
                       list(team = team, member = member))
  y <- 0.3 * d$period + effect(member, 0.9) + rnorm(nrow(d), 0, 0.7)
  y <- y - 0.9 * ave(y, team)
  nested_singular <- mixed_case("nested, no variance of teams", y, list(strategy = s, period = period),
                                c("strategy", "period"), list(team = team, member = member))

  # Crossed: persons and items.
  d <- expand.grid(item = 1:8, person = 1:20)
  d <- d[sort(sample(nrow(d), 130)), ]
  person <- level_factor("p", d$person)
  item <- level_factor("i", d$item)
  condition <- level_factor("c", 1 + (d$item + d$person) %% 3)
  y <- effect(person, 0.8) + effect(item, 0.5) + 0.3 * codes(condition) + rnorm(nrow(d))
  crossed <- mixed_case("crossed", y, list(condition = condition), "condition", list(person = person, item = item))
  half <- level_factor("h", 1 + d$person %% 2)
  y <- y + effect(factor(d$person %/% 4), 0.7)
  three_groupings <- mixed_case("nested and crossed", y, list(condition = condition, half = half),
                                c("condition", "half", "condition:half"),
                                list(class = level_factor("k", d$person %/% 4), person = person, item = item))

  # A missing cell.
  n <- 120
  a <- drawn("a", 3, n)
  b <- drawn("b", 3, n)
  keep <- !(codes(a) == 2 & codes(b) == 1)
  g <- factor(sample(paste0("g", 1:18), n, TRUE))
  y <- codes(a) - codes(b) + effect(g, 0.7) + rnorm(n)
  missing <- mixed_case("missing cell", y[keep], list(a = a[keep], b = b[keep]), c("a", "b", "a:b"),
                        list(g = g[keep]))

  # Three factors.
  n <- 200
  fs <- list(a = drawn("a", 2, n), b = drawn("b", 3, n), c = drawn("c", 2, n))
  g <- factor(sample(paste0("g", 1:30), n, TRUE))
  y <- codes(fs$a) * codes(fs$b) + effect(g, 1.2) + rnorm(n, 0, 2)
  three <- mixed_case("three factors", y, fs, c("a", "b", "c", "a:b", "a:c", "b:c", "a:b:c"), list(g = g))

  # Scale: tiny spread on a large mean, and nearly all of it between groups.
  g <- factor(rep(paste0("g", 1:12), each = 5))
  a <- drawn("a", 2, 60)
  scaled <- mixed_case("tiny spread on a large mean", 1e6 + 1e-2 * (effect(g, 1) + rnorm(60)), list(a = a), "a",
                       list(g = g), centre = 1e6)
  alike <- mixed_case("rows of a group nearly equal", effect(g, 100) + rnorm(60), list(a = a), "a", list(g = g))
  weak <- mixed_case("little group variance", effect(g, 0.3) + rnorm(60), list(a = a), "a", list(g = g))
  list(balanced, split_plot, unbalanced, additive, maximum_likelihood, alone, singular, lonely, nested, nested_singular,
       crossed, three_groupings, missing, three, scaled, alike, weak)
}

arguments <- commandArgs(trailingOnly = TRUE)
stopifnot(length(arguments) == 1)
json <- as_json(list(made_by = one(paste(R.version.string, "lme4", packageVersion("lme4"), "lmerTest",
                                         packageVersion("lmerTest"))),
                     confidence = one(0.9), mixed = cases()))
writeLines(json, arguments)
