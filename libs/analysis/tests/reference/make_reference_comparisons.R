# Writes comparisons.json, the reference values of comparisons_test.
#
#   Rscript libs/analysis/tests/reference/make_reference_comparisons.R libs/analysis/tests/reference/comparisons.json
#
# Needs R >= 4.2 with car and mvtnorm. Data are drawn here with a fixed seed and stored with the results, so that neither
# the build nor the tests need R. Confidence limits of non-centralities are roots of R's pt and pf; tails of the
# studentised range are the integral that defines them, because ptukey is off for few degrees of freedom.

suppressPackageStartupMessages({ library(car) })
options(warn = -1)  # about precision far from the roots, and about epsilons above 1
set.seed(20261123, kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")

folder <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
source(file.path(folder, "common.R"))

# ---- effect sizes ----

ncp_t <- function(t, df, p) uniroot(function(ncp) pt(t, df, ncp) - p, c(t - 12, t + 12), tol = 1e-12)$root
ncp_f <- function(f, df1, df2, p) if (pf(f, df1, df2, lower.tail = FALSE) >= p) 0 else
  uniroot(function(ncp) pf(f, df1, df2, ncp, lower.tail = FALSE) - p, c(0, 20 * f * df1 + 20), tol = 1e-12)$root
J <- function(df) exp(lgamma(df / 2) - lgamma((df - 1) / 2)) / sqrt(df / 2)

two_groups <- list()
add_groups <- function(a, b) {
  n <- c(length(a), length(b))
  df <- sum(n) - 2
  unit <- sqrt(sum(1 / n))
  t <- t.test(a, b, var.equal = TRUE)$statistic[[1]]
  d <- c(t, ncp_t(t, df, 0.975), ncp_t(t, df, 0.025)) * unit
  v <- var.test(a, b, conf.level = 0.9)
  entry <- list(a = array_of(a), b = array_of(b), d = array_of(d), g = array_of(J(df) * d),
                variance_ratio = list(ratio = v$estimate[[1]], low = v$conf.int[1], high = v$conf.int[2], p = v$p.value))
  if (n[1] == n[2]) {
    paired <- t.test(a, b, paired = TRUE)
    tp <- paired$statistic[[1]]
    entry$paired_d <- array_of(c(tp, ncp_t(tp, n[1] - 1, 0.975), ncp_t(tp, n[1] - 1, 0.025)) / sqrt(n[1]))
  }
  two_groups[[length(two_groups) + 1]] <<- entry
}
add_groups(rnorm(12), rnorm(9, 0.5))
add_groups(rnorm(5, 3), rnorm(5))
add_groups(rnorm(40), rnorm(40, 0.05))
add_groups(rnorm(3), rnorm(25, sd = 3))
add_groups(rnorm(30, 1e4), rnorm(30, 1e4 + 0.2, 0.2))
add_groups(rpois(60, 7), rpois(60, 8))
add_groups(rnorm(150), rnorm(150))

shares <- list()
for (f in c(0.3, 1, 2.4, 9, 60)) for (df in list(c(1, 8), c(3, 56), c(9, 224), c(3, 5000))) {
  n <- sum(df) + 1
  low <- ncp_f(f, df[1], df[2], 0.025)
  high <- ncp_f(f, df[1], df[2], 0.975)
  shares[[length(shares) + 1]] <- list(f = f, df1 = df[1], df2 = df[2], n = n, eta = f * df[1] / (f * df[1] + df[2]),
                                       low = low / (low + n), high = high / (high + n))
}

# ---- sphericity ----

# R's mauchly.test (also car's) has the number of levels in one place of the second-order term where the expansion has
# the number of contrasts. The p-value is stored as R has it and with the right term.
mauchly_p <- function(w, p, n) {
  rho <- 1 - (2 * p^2 + p + 2) / (6 * p * n)
  w2 <- (p + 2) * (p - 1) * (p - 2) * (2 * p^3 + 6 * p^2 + 3 * p + 2) / (288 * (n * p * rho)^2)
  z <- -n * rho * log(w)
  f <- p * (p + 1) / 2 - 1
  first <- pchisq(z, f, lower.tail = FALSE)
  first + w2 * (pchisq(z, f + 4, lower.tail = FALSE) - first)
}
sphericity <- list()
add_blocks <- function(name, k, sizes, autocorrelation, spread = rep(1, k)) {
  n <- sum(sizes)
  group <- rep(seq_along(sizes), sizes)
  covariance <- autocorrelation^abs(outer(1:k, 1:k, "-")) * outer(spread, spread)
  y <- mvtnorm::rmvnorm(n, sigma = covariance) + 2 * rnorm(n) + outer(group, 1:k) * 0.15
  wide <- if (length(sizes) > 1) lm(y ~ factor(group), contrasts = list("factor(group)" = "contr.sum")) else lm(y ~ 1)
  idata <- data.frame(within = factor(1:k))
  s <- summary(Anova(wide, idata = idata, idesign = ~within, type = 3), multivariate = FALSE)
  last <- nrow(s$univariate.tests)
  d <- expand.grid(block = 1:n, within = 1:k)
  sphericity[[length(sphericity) + 1]] <<- list(
    name = name, y = array_of(as.vector(y)), block = array_of(d$block - 1), within = array_of(d$within - 1),
    between = array_of(group[d$block] - 1),
    w = if (length(s$sphericity.tests)) s$sphericity.tests[1, 1] else NA,
    p = if (length(s$sphericity.tests)) s$sphericity.tests[1, 2] else NA,
    p_expansion = if (length(s$sphericity.tests)) mauchly_p(s$sphericity.tests[1, 1], k - 1, n - length(sizes)) else NA,
    gg = if (length(s$pval.adjustments)) s$pval.adjustments[1, "GG eps"] else NA,
    hf = if (length(s$pval.adjustments)) s$pval.adjustments[1, "HF eps"] else NA,
    p_gg = if (length(s$pval.adjustments)) s$pval.adjustments[1, "Pr(>F[GG])"] else NA,
    p_hf = if (length(s$pval.adjustments)) s$pval.adjustments[1, "Pr(>F[HF])"] else NA,
    f = s$univariate.tests[last - (length(sizes) > 1), "F value"],
    interaction_p_gg = if (length(sizes) > 1 && length(s$pval.adjustments)) s$pval.adjustments[2, "Pr(>F[GG])"] else NA,
    equal = length(unique(sizes)) == 1)
}
add_blocks("four levels, one group", 4, 12, 0.2)
add_blocks("autocorrelated", 4, 15, 0.9)
add_blocks("unequal spread", 5, 10, 0.1, c(1, 1, 1, 4, 8))
add_blocks("three levels", 3, 6, 0.5)
add_blocks("two levels", 2, 9, 0.5)
add_blocks("three groups of eight", 4, c(8, 8, 8), 0.6)
add_blocks("groups of unequal size", 3, c(4, 9, 6), 0.7)
add_blocks("six levels, many blocks", 6, c(40, 40), 0.3)

# ---- write ----

made_by <- paste0(R.version.string, ", car ", packageVersion("car"))
writeLines(paste0("{\"made_by\":\"", made_by, "\",\n",
                  paste(lines("two_groups", two_groups), lines("shares", shares), lines("sphericity", sphericity), sep = ",\n"),
                  "\n}"),
           commandArgs(TRUE)[1])
