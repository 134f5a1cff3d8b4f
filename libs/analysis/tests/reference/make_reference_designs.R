# Writes designs.json, the reference values of r_agreement_test: the same designs for every procedure.
#
#   Rscript libs/analysis/tests/reference/make_reference_designs.R libs/analysis/tests/reference/designs.json
#
# Needs R >= 4.2 with car and emmeans. Data are drawn here with a fixed seed and stored with the results, so that neither
# the build nor the tests need R.
#
# Tails of the studentised range are the integral that defines them, because ptukey is off for few degrees of freedom.

suppressPackageStartupMessages({
  library(car)
  library(emmeans)
})
RNGkind("Mersenne-Twister", "Inversion", "Rejection")
emm_options(msg.interaction = FALSE, msg.nesting = FALSE)

folder <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
source(file.path(folder, "common.R"))

# ---- designs ----

# counts: rows of every cell. flat: one cell of equal values.
design <- function(name, counts, terms, flat = FALSE) list(name = name, counts = counts, terms = terms, flat = flat)
cells <- function(dim, ...) array(c(...), dim)
two <- c("a", "b")
crossed <- c("a", "b", "a:b")
three <- c("a", "b", "c")
pairs <- c(three, "a:b", "a:c", "b:c")
full <- c(pairs, "a:b:c")

designs <- list(
  design("one factor, unbalanced", cells(4, 6, 12, 5, 14), "a"),
  design("one factor, a level with one row", cells(4, 9, 1, 7, 12), "a"),
  design("one factor, a level without spread", cells(3, 8, 9, 15), "a", flat = TRUE),
  design("2 x 3, unbalanced", cells(c(2, 3), 6, 10, 4, 13, 8, 11), crossed),
  design("2 x 3, unbalanced, additive", cells(c(2, 3), 6, 10, 4, 13, 8, 11), two),
  design("3 x 3, very unbalanced, groups of one row", cells(c(3, 3), 2, 15, 4, 30, 5, 2, 8, 7, 19), crossed),
  design("3 x 3, confounded", cells(c(3, 3), 22, 2, 3, 3, 20, 2, 2, 3, 24), crossed),
  design("3 x 3, confounded, additive", cells(c(3, 3), 30, 2, 1, 3, 26, 2, 2, 1, 24), two),
  design("2 x 2, confounded, without spread", cells(c(2, 2), 22, 4, 5, 18), crossed, flat = TRUE),
  design("3 x 3, confounded, two empty cells", cells(c(3, 3), 20, 0, 4, 3, 22, 0, 2, 5, 24), crossed),
  design("3 x 3, confounded, two empty cells, additive", cells(c(3, 3), 20, 0, 1, 3, 22, 0, 2, 1, 24), two),
  design("2 x 3, an empty cell", cells(c(2, 3), 9, 8, 0, 12, 6, 14), crossed),
  design("4 x 3, two empty cells, without spread", cells(c(4, 3), 7, 9, 5, 7, 0, 11, 4, 9, 8, 0, 7, 6), crossed, flat = TRUE),
  design("3 x 2, one row in some cells", cells(c(3, 2), 1, 9, 12, 8, 1, 10), crossed),
  design("4 x 5, one row in every cell, additive", cells(c(4, 5), rep(1, 20)), two),
  design("2 x 3, one row in a cell, without spread", cells(c(2, 3), 9, 1, 12, 8, 10, 7), two, flat = TRUE),
  design("2 x 3 x 2, balanced", cells(c(2, 3, 2), rep(6, 12)), full),
  design("2 x 3 x 2, unbalanced", cells(c(2, 3, 2), 4, 6, 9, 5, 7, 8, 10, 4, 5, 6, 11, 3), full),
  design("2 x 2 x 3, unbalanced, additive", cells(c(2, 2, 3), 4, 6, 9, 5, 7, 8, 10, 4, 5, 6, 11, 3), three, flat = TRUE),
  design("2 x 3 x 2, confounded, additive", cells(c(2, 3, 2), 16, 2, 9, 8, 2, 17, 12, 3, 6, 9, 1, 14), three),
  design("2 x 2 x 2, confounded", cells(c(2, 2, 2), 16, 2, 3, 18, 14, 4, 2, 15), pairs, flat = TRUE),
  design("2 x 3 x 2, empty cells", cells(c(2, 3, 2), 6, 7, 0, 8, 5, 9, 8, 6, 7, 0, 10, 6), c(three, "a:b", "a:c")),
  design("2 x 3 x 2, empty cells, all interactions", cells(c(2, 3, 2), 6, 7, 0, 8, 5, 9, 8, 6, 7, 11, 10, 6), full),
  design("3 x 2 x 2, one row in some cells", cells(c(3, 2, 2), 1, 7, 9, 8, 1, 9, 8, 6, 7, 1, 10, 6), pairs)
)

factors_of <- function(counts) {
  index <- arrayInd(rep(seq_along(counts), counts), dim(counts))
  fs <- lapply(seq_along(dim(counts)), function(f) factor(letters[index[, f]], levels = letters[seq_len(dim(counts)[f])]))
  names(fs) <- letters[seq_along(fs)]
  fs
}
effects_of <- function(fs) Reduce(`+`, lapply(fs, function(f) rnorm(nlevels(f), 0, 0.5)[f]))
formula_of <- function(terms, left = "y") reformulate(terms, left)

# Rows of the cell whose values a flat design makes equal: the first of several rows.
flat_rows <- function(fs) {
  cell <- interaction(fs, drop = TRUE)
  which(cell == names(which(table(cell)[unique(as.character(cell))] > 1))[1])
}

# ---- comparisons of marginal means ----

# b and V: coefficients and covariance of the columns that are kept, in the order of lm's. test(l): df, and se if it is
# not from V.
comparisons_of <- function(twin, fs, b, V, df_of) {
  kept <- !is.na(coef(twin))
  stopifnot(sum(kept) == length(b))
  estimate <- function(L, basis, tukey = NULL) lapply(seq_len(nrow(L)), function(i) {
    l <- L[i, ]
    if (!estimability::is.estble(l, basis)) return(list(estimate = one(NA)))
    l <- l[kept]
    value <- sum(l * b)
    se <- sqrt(drop(l %*% V %*% l))
    df <- df_of(l)
    t <- value / se
    result <- list(estimate = one(value), se = one(se), df = one(if (is.infinite(df)) NA else df), p = one(2 * pt(-abs(t), df)))
    if (!is.null(tukey)) result$tukey <- one(if (tukey < 3) NA else tukey_upper(sqrt(2) * abs(t), tukey, df))
    result
  })
  lapply(seq_along(fs), function(f) {
    grid <- emmeans(twin, names(fs)[f], data = twin$model)
    L <- grid@linfct
    k <- nrow(L)
    known <- sum(vapply(seq_len(k), function(i) estimability::is.estble(L[i, ], grid@nbasis), TRUE))
    each <- combn(k, 2)
    weights <- seq(-1, 1, length.out = k)
    list(over = one(f - 1), means = estimate(L, grid@nbasis),
         pairs = estimate(L[each[2, ], , drop = FALSE] - L[each[1, ], , drop = FALSE], grid@nbasis, known),
         weights = weights, contrast = estimate(matrix(weights %*% L, 1), grid@nbasis, 2))
  })
}

# The combinations are those of emmeans on the model itself, where it takes it.
check <- function(object, fs, comparisons, tolerance = 1e-6, check_df = TRUE, ...) {
  for (f in seq_along(fs)) {
    s <- as.data.frame(summary(emmeans(object, names(fs)[f], ...)))
    column <- intersect(c("emmean", "rate", "prob"), names(s))
    ours <- vapply(comparisons[[f]]$means, function(m) m$estimate[[1]], 0)
    field <- function(name) vapply(comparisons[[f]]$means, function(m) if (is.null(m[[name]])) NA else m[[name]][[1]], 0)
    se <- field("se")
    df <- field("df")
    stopifnot(all(is.na(ours) == is.na(s[[column]])), all(abs(ours - s[[column]]) < tolerance * pmax(1, abs(ours)), na.rm = TRUE),
              all(abs(se / s$SE - 1) < max(tolerance, 1e-5), na.rm = TRUE),
              !check_df || all(abs(df / s$df - 1) < max(10 * tolerance, 1e-5), na.rm = TRUE))
  }
}

# ---- models ----

linear <- function(d, fs, design) {
  d$y <- effects_of(fs) + rnorm(nrow(d))
  if (design$flat) d$y[flat_rows(fs)] <- 0.7
  model <- lm(formula_of(design$terms), d)
  kept <- !is.na(coef(model))
  comparisons <- comparisons_of(model, fs, coef(model)[kept], vcov(model)[kept, kept], function(l) df.residual(model))
  check(model, fs, comparisons, 1e-9, data = d)
  list(y = d$y, comparisons = comparisons)
}

entries <- lapply(seq_along(designs), function(i) {
  design <- designs[[i]]
  fs <- factors_of(design$counts)
  d <- as.data.frame(fs)
  set.seed(1000 * i + nchar("linear"))
  list(name = one(design$name), factors = factors_json(fs), terms = terms_json(design$terms, fs),
       linear = linear(d, fs, design))
})

# ---- within people ----

# Sizes of the groups of people. flat: people do not differ but by chance.
within_people <- function(name, levels, sizes, autocorrelation, spread = rep(1, levels), flat = FALSE) {
  set.seed(nchar(name) + 100 * levels + sum(sizes))
  n <- sum(sizes)
  group <- rep(seq_along(sizes), sizes)
  covariance <- autocorrelation^abs(outer(1:levels, 1:levels, "-")) * outer(spread, spread)
  y <- mvtnorm::rmvnorm(n, sigma = covariance) + outer(group, 1:levels) * 0.15
  y <- if (flat) y - rowMeans(y) else y + 2 * rnorm(n)
  wide <- if (length(sizes) > 1) lm(y ~ factor(group), contrasts = list("factor(group)" = "contr.sum")) else lm(y ~ 1)
  s <- summary(Anova(wide, idata = data.frame(within = factor(1:levels)), idesign = ~within, type = 3), multivariate = FALSE)
  d <- expand.grid(person = 1:n, within = 1:levels)
  d$group <- group[d$person]
  d$y <- as.vector(y)
  model <- if (length(sizes) > 1) y ~ factor(within) * factor(group) + Error(factor(person)) else
    y ~ factor(within) + Error(factor(person))
  table <- summary(aov(model, data = d))[["Error: Within"]][[1]]
  residual <- table[nrow(table), "Df"]
  gg <- s$pval.adjustments[1, "GG eps"]
  hf <- min(1, s$pval.adjustments[1, "HF eps"])
  tests <- lapply(seq_len(nrow(table) - 1), function(i) {
    corrected <- function(epsilon) pf(table[i, "F value"], epsilon * table[i, "Df"], epsilon * residual, lower.tail = FALSE)
    list(f = one(table[i, "F value"]), p = one(table[i, "Pr(>F)"]), p_gg = one(corrected(gg)), p_hf = one(corrected(hf)))
  })
  # car's own corrected p, where its type III is aov's test.
  if (length(unique(sizes)) == 1) stopifnot(abs(s$pval.adjustments[1, "Pr(>F[GG])"] / tests[[1]]$p_gg[[1]] - 1) < 1e-6)
  list(name = one(name), y = d$y, person = d$person - 1, within = d$within - 1, group = d$group - 1,
       w = one(s$sphericity.tests[1, 1]), gg = one(gg), hf = one(hf), tests = tests)
}
people <- list(
  within_people("one group", 4, 12, 0.2),
  within_people("one group, autocorrelated", 4, 15, 0.9),
  within_people("one group, unequal spread", 5, 10, 0.1, c(1, 1, 1, 4, 8)),
  within_people("three levels", 3, 6, 0.5),
  within_people("eight levels", 8, 14, 0.6),
  within_people("no variance of people", 4, 12, 0.2, flat = TRUE),
  within_people("no variance of people, two groups", 3, c(8, 8), 0.4, flat = TRUE),
  within_people("no variance of people, unequal groups", 4, c(5, 11, 7), 0.4, flat = TRUE),
  within_people("two groups", 4, c(9, 9), 0.6),
  within_people("three groups", 4, c(8, 8, 8), 0.6),
  within_people("three groups, six levels", 6, c(7, 7, 7), 0.8),
  within_people("unequal groups", 3, c(4, 9, 6), 0.7),
  within_people("unequal groups, autocorrelated", 5, c(4, 12), 0.9),
  within_people("very unequal groups", 4, c(2, 40, 5), 0.3),
  within_people("unequal groups, unequal spread", 4, c(6, 9), 0.2, c(1, 2, 4, 8)),
  within_people("a group of one person", 4, c(1, 9, 8), 0.5),
  within_people("two groups of one person", 3, c(1, 1, 10), 0.5),
  within_people("a group of one person, autocorrelated", 5, c(14, 1), 0.8),
  within_people("many people", 6, c(40, 40), 0.3),
  within_people("many people, unequal groups", 4, c(60, 25, 10, 5), 0.6)
)

# ---- write ----

arguments <- commandArgs(trailingOnly = TRUE)
stopifnot(length(arguments) == 1)
packages <- c("car", "emmeans")
writeLines(as_json(list(made_by = one(paste(R.version.string, paste(packages, vapply(packages, function(p) as.character(packageVersion(p)), ""),
                                                                    collapse = " "))),
                        designs = entries, within_people = people)), arguments)
cat(length(entries), "designs,", length(people), "tables within people\n")
