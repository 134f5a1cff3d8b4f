# Writes responses.json, the reference values of cumulative_logit_test, quasi_poisson_test and censored_counts_test.
#
#   Rscript libs/stats/tests/reference/make_reference_responses.R libs/stats/tests/reference/responses.json
#
# Needs R >= 4.1 with ordinal, car and numDeriv (Debian: r-cran-ordinal, r-cran-car, r-cran-numderiv). Data sets are
# drawn here with fixed seeds and stored with the results, so that neither the build nor the tests need R. What these
# packages lack, Brant's test and the negative binomial likelihood with censored counts, is computed here from its
# definition.

suppressPackageStartupMessages({
  library(ordinal)
  library(car)
  library(numDeriv)
})

RNGkind("Mersenne-Twister", "Inversion", "Rejection")

folder <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
source(file.path(folder, "common.R"))

right <- function(terms) if (length(terms)) paste(terms, collapse = "+") else "1"

# Terms that do not contain `term`, with it and without it: type II.
contains <- function(a, b) all(strsplit(b, ":")[[1]] %in% strsplit(a, ":")[[1]])
type_two <- function(terms, term) {
  without <- terms[!vapply(terms, contains, TRUE, b = term)]
  list(with = c(without, term), without = without)
}

# ---- ordinal ----

brant <- function(y, x) {
  k <- nlevels(y) - 1
  p <- ncol(x) - 1
  fits <- lapply(seq_len(k), function(j)
    suppressWarnings(glm.fit(x, as.integer(y) > j, family = binomial(), control = glm.control(epsilon = 1e-14, maxit = 100))))
  # A split that some levels separate has no maximum.
  if (any(abs(unlist(lapply(fits, function(f) f$coefficients))) > 12)) return(list(separated = one(TRUE)))
  above <- sapply(fits, fitted)
  inverse <- lapply(seq_len(k), function(j) solve(crossprod(x, above[, j] * (1 - above[, j]) * x)))
  v <- matrix(0, k * p, k * p)
  for (j in seq_len(k)) for (l in j:k) {
    w <- above[, l] - above[, j] * above[, l]
    block <- (inverse[[j]] %*% crossprod(x, w * x) %*% inverse[[l]])[-1, -1]
    v[(j - 1) * p + seq_len(p), (l - 1) * p + seq_len(p)] <- block
    v[(l - 1) * p + seq_len(p), (j - 1) * p + seq_len(p)] <- t(block)
  }
  b <- unlist(lapply(fits, function(f) f$coefficients[-1]))
  d <- cbind(kronecker(rep(1, k - 1), diag(p)), -diag((k - 1) * p))
  statistic <- drop(t(d %*% b) %*% solve(d %*% v %*% t(d), d %*% b))
  df <- (k - 1) * p
  list(statistic = one(statistic), df = one(df), p = one(pchisq(statistic, df, lower.tail = FALSE)))
}

ordinal_case <- function(name, y, fs, terms, with_brant = TRUE) {
  d <- as.data.frame(c(list(y = droplevels(y)), fs))
  control <- clm.control(gradTol = 1e-12, maxIter = 200)
  fit_terms <- function(t) suppressWarnings(clm(as.formula(paste("y ~", right(t))), data = d, control = control))
  fit <- fit_terms(terms)
  tests <- lapply(terms, function(term) {
    m <- type_two(terms, term)
    a <- fit_terms(m$with)
    b <- fit_terms(m$without)
    df <- a$edf - b$edf
    lr <- 2 * (a$logLik - b$logLik)
    list(name = one(term), df = one(df), statistic = one(lr), p = one(pchisq(lr, df, lower.tail = FALSE)))
  })
  k <- length(fit$alpha)
  beta <- fit$beta[!is.na(fit$beta)]
  v <- vcov(fit)
  v <- v[!is.na(diag(v)), !is.na(diag(v))]
  latent <- rbind(c(rep(-1 / k, k), rep(0, length(beta))), cbind(matrix(0, length(beta), k), diag(length(beta))))
  out <- list(name = one(name), response = factor_json("y", y), factors = factors_json(fs),
              terms = terms_json(terms, fs), log_likelihood = one(as.numeric(fit$logLik)),
              thresholds = unname(fit$alpha), threshold_errors = unname(sqrt(diag(v))[seq_len(k)]),
              coefficients = c(-mean(fit$alpha), unname(beta)),
              covariance = as.vector(latent %*% v %*% t(latent)), tests = tests)
  if (with_brant) {
    x <- model.matrix(as.formula(paste("~", right(terms))), d)
    x <- x[, qr(x)$pivot[seq_len(qr(x)$rank)], drop = FALSE]
    out$brant <- brant(d$y, x)
  }
  out
}

likert <- function(eta, cuts) {
  x <- eta + rlogis(length(eta))
  factor(findInterval(x, cuts) + 1, levels = seq_len(length(cuts) + 1))
}

ordinal_cases <- function() {
  set.seed(21)
  n <- 240
  fs <- list(strategy = drawn("s", 4, n), type = drawn("t", 2, n))
  eta <- 0.4 * codes(fs$strategy) - 0.5 * codes(fs$type)
  cuts <- c(-1.5, -0.3, 0.8, 2)
  full <- c("strategy", "type", "strategy:type")
  crossed <- ordinal_case("Likert, two factors", likert(eta, cuts), fs, full)
  additive <- ordinal_case("Likert, additive", likert(eta, cuts), fs, c("strategy", "type"))
  seven <- ordinal_case("seven levels, rare ends", likert(eta, c(-4, -2, -1, 0, 1.5, 4)), fs, "strategy", FALSE)
  alone <- ordinal_case("no factors", likert(eta, cuts), list(), character(0), FALSE)
  binary <- ordinal_case("two levels", likert(eta, 0.2), fs, c("strategy", "type"), FALSE)
  y <- likert(eta, cuts)
  levels(y) <- c("1", "2", "3", "5", "6")
  y <- factor(y, levels = as.character(1:6))
  unused <- ordinal_case("a level nobody chose", y, fs["type"], "type")
  keep <- !(codes(fs$strategy) == 3 & codes(fs$type) == 1)
  missing <- ordinal_case("missing cell", likert(eta, cuts)[keep], lapply(fs, `[`, keep), full)
  n <- 400
  fs <- list(a = drawn("a", 2, n), b = drawn("b", 3, n, c(0.6, 0.3, 0.1)), c = drawn("c", 2, n))
  eta <- codes(fs$a) - codes(fs$b) * codes(fs$c)
  three <- ordinal_case("three factors, unbalanced", likert(eta, c(-1, 1)), fs,
                        c("a", "b", "c", "a:b", "a:c", "b:c", "a:b:c"))
  spread <- ordinal_case("odds that are not proportional", likert(eta * 0, c(-1, 0, 1)), fs["a"], "a")
  list(crossed, additive, seven, alone, binary, unused, missing, three, spread)
}

# ---- quasi-Poisson ----

quasi_case <- function(name, y, fs, terms) {
  d <- as.data.frame(c(list(y = y), fs))
  control <- glm.control(epsilon = 1e-14, maxit = 200)
  fit_terms <- function(t) glm(as.formula(paste("y ~", right(t))), quasipoisson, d, control = control)
  fit <- fit_terms(terms)
  dispersion <- summary(fit)$dispersion
  kept <- !is.na(coef(fit))
  tests <- lapply(terms, function(term) {
    m <- type_two(terms, term)
    a <- fit_terms(m$with)
    b <- fit_terms(m$without)
    df <- b$df.residual - a$df.residual
    f <- (b$deviance - a$deviance) / df / dispersion
    list(name = one(term), df = one(df), f = one(f), p = one(pf(f, df, fit$df.residual, lower.tail = FALSE)))
  })
  # The same as car's, where it has an answer.
  if (length(terms) && all(kept)) {
    table <- Anova(fit, type = 2, test.statistic = "F", error.estimate = "pearson")
    ours <- vapply(tests, function(t) t$f[[1]], 0)
    stopifnot(all(abs(table$`F values`[seq_along(ours)] / ours - 1) < 1e-8))
  }
  s <- summary(fit)
  list(name = one(name), counts = y, factors = factors_json(fs), terms = terms_json(terms, fs),
       dispersion = one(dispersion), residual_df = one(fit$df.residual), coefficients = unname(coef(fit)[kept]),
       covariance = as.vector(s$cov.scaled), p = unname(s$coefficients[, 4]), tests = tests)
}

quasi_cases <- function() {
  set.seed(22)
  n <- 160
  fs <- list(strategy = drawn("s", 4, n), composition = drawn("c", 4, n))
  full <- c("strategy", "composition", "strategy:composition")
  periods <- pmax(4, round(rnorm(n, 7.7 + 0.4 * codes(fs$strategy), 1.5)))
  under <- quasi_case("underdispersed periods", periods, fs, full)
  additive <- quasi_case("underdispersed, additive", periods, fs, c("strategy", "composition"))
  over <- quasi_case("overdispersed", rnbinom(n, size = 2, mu = 4), fs, full)
  alone <- quasi_case("no factors", periods, list(), character(0))
  keep <- !(codes(fs$strategy) == 1 & codes(fs$composition) == 2)
  missing <- quasi_case("missing cell", periods[keep], lapply(fs, `[`, keep), full)
  fs <- list(a = drawn("a", 2, n), b = drawn("b", 3, n, c(0.6, 0.3, 0.1)), c = drawn("c", 2, n))
  three <- quasi_case("three factors", round(rnorm(n, 20 + 3 * codes(fs$a), 2)), fs,
                      c("a", "b", "c", "a:b", "a:c", "b:c", "a:b:c"))
  list(under, additive, over, alone, missing, three)
}

# ---- negative binomial with censored counts ----

# Polished by Newton's method on the whole likelihood: coefficients, then log(theta).
censored_fit <- function(y, observed, x) {
  minus <- function(par) {
    mu <- exp(drop(x %*% par[seq_len(ncol(x))]))
    size <- exp(par[ncol(x) + 1])
    -sum(ifelse(observed, dnbinom(y, size, mu = mu, log = TRUE),
                pnbinom(y, size, mu = mu, lower.tail = FALSE, log.p = TRUE)))
  }
  start <- c(log(mean(y) + 1), rep(0, ncol(x) - 1), 1)
  par <- optim(start, minus, method = "BFGS", control = list(maxit = 1000, reltol = 1e-14))$par
  for (i in 1:6) par <- par - solve(hessian(minus, par), grad(minus, par))
  stopifnot(max(abs(grad(minus, par))) < 1e-6)
  list(par = par, value = -minus(par), hessian = hessian(minus, par))
}

censored_case <- function(name, y, observed, fs, terms) {
  d <- as.data.frame(c(list(y = y), fs))
  fit_terms <- function(t) {
    x <- model.matrix(as.formula(paste("~", right(t))), d)
    censored_fit(y, observed, x[, qr(x)$pivot[seq_len(qr(x)$rank)], drop = FALSE])
  }
  fit <- fit_terms(terms)
  p <- length(fit$par) - 1
  tests <- lapply(terms, function(term) {
    m <- type_two(terms, term)
    a <- fit_terms(m$with)
    b <- fit_terms(m$without)
    df <- length(a$par) - length(b$par)
    lr <- 2 * (a$value - b$value)
    list(name = one(term), df = one(df), statistic = one(lr), p = one(pchisq(lr, df, lower.tail = FALSE)))
  })
  list(name = one(name), counts = y, observed = observed, factors = factors_json(fs), terms = terms_json(terms, fs),
       log_likelihood = one(fit$value), theta = one(exp(fit$par[p + 1])), coefficients = fit$par[seq_len(p)],
       covariance = as.vector(solve(fit$hessian)[seq_len(p), seq_len(p)]), tests = tests)
}

censored_cases <- function() {
  set.seed(23)
  n <- 200
  fs <- list(a = drawn("a", 3, n), b = drawn("b", 2, n))
  full <- c("a", "b", "a:b")
  mu <- exp(1.8 + 0.3 * codes(fs$a) - 0.4 * codes(fs$b))
  y <- rnbinom(n, size = 2.5, mu = mu)
  cap <- censored_case("cut at a cap", pmin(y, 15), y <= 15, fs, full)
  random <- rpois(n, 12)
  mixed <- censored_case("censored at different counts", pmin(y, random), y <= random, fs, c("a", "b"))
  none <- censored_case("nothing censored", y, rep(TRUE, n), fs, c("a", "b"))
  heavy <- censored_case("most censored", pmin(y, 4), y <= 4, fs["b"], "b")
  alone <- censored_case("no factors", pmin(y, 10), y <= 10, list(), character(0))
  list(cap, mixed, none, heavy, alone)
}

arguments <- commandArgs(trailingOnly = TRUE)
stopifnot(length(arguments) == 1)
json <- as_json(list(made_by = one(paste(R.version.string, "ordinal", packageVersion("ordinal"), "car",
                                         packageVersion("car"))),
                     ordinal = ordinal_cases(), quasi_poisson = quasi_cases(), censored = censored_cases()))
writeLines(json, arguments)
