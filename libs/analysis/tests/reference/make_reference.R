# Writes anova.json beside this script: data sets, and what R 4.2 says of them. Run by hand,
#
#   Rscript libs/analysis/tests/reference/make_reference.R
#
# only to add data sets; neither build nor tests need R. Needs no packages.
#
# Values at a scale of 2^498 (8e149) or 2^-498, and at an offset of 1e8, are exact images of the values that R
# analyses: R's own least squares would lose digits that the statistics do not depend on.
# Tails of the studentised range are stored twice: by ptukey, which is off by up to two percent for few degrees of
# freedom or large statistics, and as the double integral that defines them, by integrate().

set.seed(20240601, kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")
options(warn = 1)

folder <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
source(file.path(folder, "common.R"))

# ---- analysis of variance ----

term_label <- function(term, names) paste(names[term], collapse = ":")

fit <- function(labels, data) {
  rhs <- if (length(labels) == 0) "1" else paste(labels, collapse = " + ")
  lm(as.formula(paste("y ~", rhs)), data = data)
}

row_of <- function(label, ss, df, rss, rdf) {
  f <- (ss / df) / (rss / rdf)
  list(name = label, df = df, ss = ss, f = f, p = pf(f, df, rdf, lower.tail = FALSE), eta = ss / (ss + rss))
}

# Each term after all that do not contain it: a comparison of two fitted models.
type_two <- function(terms, names, data) {
  labels <- vapply(terms, term_label, "", names)
  full <- fit(labels, data)
  rows <- lapply(seq_along(terms), function(t) {
    contains <- vapply(terms, function(other) all(terms[[t]] %in% other), TRUE)
    without <- fit(labels[!contains], data)
    with <- fit(c(labels[!contains], labels[t]), data)
    row_of(labels[t], deviance(without) - deviance(with), with$rank - without$rank, deviance(full), df.residual(full))
  })
  list(terms = rows, residual_ss = deviance(full), residual_df = df.residual(full))
}

tukey <- function(y, g) {
  model <- aov(y ~ g, data = data.frame(y = y, g = g))
  table <- TukeyHSD(model)$g
  k <- nlevels(g)
  n <- tabulate(g)
  pairs <- which(lower.tri(matrix(0, k, k)), arr.ind = TRUE)
  ms <- deviance(model) / df.residual(model)
  lapply(seq_len(nrow(table)), function(i) {
    se <- sqrt(ms / 2 * (1 / n[pairs[i, 1]] + 1 / n[pairs[i, 2]]))
    q <- abs(table[i, "diff"]) / se
    list(first = pairs[i, 2] - 1, second = pairs[i, 1] - 1, diff = table[[i, "diff"]], low = table[[i, "lwr"]],
         high = table[[i, "upr"]], p = ptukey(q, k, df.residual(model), lower.tail = FALSE),
         p_integral = tukey_upper(q, k, df.residual(model)))
  })
}

# ---- tests of one factor ----

t_fields <- function(t) list(diff = if (length(t$estimate) == 2) t$estimate[[1]] - t$estimate[[2]] else t$estimate[[1]],
                             se = t$stderr, t = t$statistic[[1]], df = t$parameter[[1]], p = t$p.value,
                             low = t$conf.int[1], high = t$conf.int[2])

test_fields <- function(statistic, df, p) list(statistic = statistic, df = array_of(df), p = p)

one_factor <- function(y, g) {
  g <- factor(g)
  n <- tabulate(g)
  groups <- split(y, g)
  spread <- all(n >= 2) && all(vapply(groups, var, 0) > 0)
  result <- list()
  one <- summary(aov(y ~ g))[[1]]
  result$one_way <- test_fields(one[1, "F value"], one[, "Df"], one[1, "Pr(>F)"])
  kw <- kruskal.test(y, g)
  result$kruskal <- test_fields(kw$statistic[[1]], kw$parameter[[1]], kw$p.value)
  if (spread) {
    welch <- oneway.test(y ~ g, var.equal = FALSE)
    result$welch <- test_fields(welch$statistic[[1]], unname(welch$parameter), welch$p.value)
  }
  if (spread && all(n >= 3)) {
    bf <- summary(aov(abs(y - ave(y, g, FUN = median)) ~ g))[[1]]
    result$brown_forsythe <- test_fields(bf[1, "F value"], bf[, "Df"], bf[1, "Pr(>F)"])
  }
  if (n[1] >= 2 && n[2] >= 2 && var(groups[[1]]) + var(groups[[2]]) > 0) {
    result$welch_t <- t_fields(t.test(groups[[1]], groups[[2]], conf.level = 0.9))
    m <- min(n[1], n[2])
    if (m >= 2 && var(groups[[1]][1:m] - groups[[2]][1:m]) > 0)
      result$paired_t <- t_fields(t.test(groups[[1]][1:m], groups[[2]][1:m], paired = TRUE))
    pooled <- sqrt(((n[1] - 1) * var(groups[[1]]) + (n[2] - 1) * var(groups[[2]])) / (n[1] + n[2] - 2))
    df <- n[1] + n[2] - 2
    d <- (mean(groups[[1]]) - mean(groups[[2]])) / pooled
    result$hedges_g <- d * exp(lgamma(df / 2) - lgamma((df - 1) / 2)) / sqrt(df / 2)
  }
  if (df.residual(aov(y ~ g)) >= 2) result$tukey <- tukey(y, g)
  result
}

# ---- data sets ----

# Codes from 0 of every observation, from the number of observations of each cell (first factor fastest).
cells <- function(counts) {
  index <- arrayInd(rep(seq_along(counts), counts), dim(counts))
  lapply(seq_along(dim(counts)), function(f) index[, f] - 1)
}

noise <- function(codes, sd = 1, effect = 0.7) {
  y <- rnorm(length(codes[[1]]), 0, sd)
  for (f in seq_along(codes)) y <- y + effect * rnorm(max(codes[[f]]) + 1)[codes[[f]] + 1]
  y
}

full_terms <- function(n) {
  sets <- unlist(lapply(seq_len(n), function(m) combn(n, m, simplify = FALSE)), recursive = FALSE)
  sets
}

data_sets <- list()
# `analysed` is what R sees; the stored values are analysed * 2^exponent + offset.
add <- function(name, codes, analysed, terms = full_terms(length(codes)), exponent = 0, offset = 0) {
  stored <- analysed * 2^exponent + offset
  if (offset != 0) analysed <- stored - offset
  if (!are_crossed(codes)) return(invisible())  # drawn all the same, so that what follows stays
  names <- letters[seq_along(codes)]
  data <- data.frame(y = analysed)
  for (f in seq_along(codes)) data[[names[f]]] <- factor(codes[[f]])
  entry <- list(name = name, y = array_of(stored), exponent = exponent, offset = offset,
                factors = lapply(codes, array_of), terms = lapply(terms, function(t) array_of(t - 1)),
                squares = type_two(terms, names, data),
                tests = one_factor(analysed, data$a))
  data_sets[[length(data_sets) + 1]] <<- entry
}

balanced <- function(...) array(list(...)[[length(list(...))]], unlist(list(...)[-length(list(...))]))

for (k in 2:6) { d <- cells(balanced(k, 5)); add(paste0("one-way, ", k, " levels"), d, noise(d)) }
d <- cells(array(c(3, 9, 2, 14), 4)); add("one-way, unbalanced", d, noise(d, sd = 2))
d <- cells(array(c(2, 40, 5), 3)); add("one-way, unequal variances", d, noise(d) * c(1, 10, 0.1)[d[[1]] + 1])
d <- cells(array(c(1, 4, 1), 3)); add("one-way, single observations", d, noise(d))
d <- cells(balanced(4, 4, 15)); add("the published design", d, noise(d))
d <- cells(balanced(2, 2, 3)); add("2 x 2 balanced", d, noise(d))
d <- cells(balanced(6, 2, 2)); add("6 x 2 balanced", d, noise(d))
d <- cells(balanced(3, 5, 4)); add("3 x 5 balanced", d, noise(d))
d <- cells(array(c(3, 5, 2, 7, 4, 6), c(2, 3))); add("2 x 3 unbalanced", d, noise(d))
d <- cells(array(c(1, 9, 2, 30, 3, 1, 5, 5, 12), c(3, 3))); add("3 x 3 very unbalanced", d, noise(d))
d <- cells(array(sample(1:6, 24, TRUE), c(4, 6))); add("4 x 6 unbalanced", d, noise(d))
d <- cells(array(c(4, 3, 0, 5, 2, 6), c(2, 3))); add("2 x 3 with an empty cell", d, noise(d))
d <- cells(array(c(3, 4, 2, 3, 0, 5, 2, 6, 4, 0, 3, 3), c(3, 4))); add("3 x 4 with two empty cells", d, noise(d))
d <- cells(array(c(5, 0, 4, 0, 3, 6, 4, 2, 0), c(3, 3))); add("3 x 3 with three empty cells", d, noise(d))
d <- cells(balanced(3, 4, 1)); add("one observation per cell, additive", d, noise(d), terms = list(1, 2))
d <- cells(array(c(1, 1, 2, 1, 1, 1), c(3, 2))); add("one cell with two observations", d, noise(d))
d <- cells(balanced(3, 3, 4)); add("additive model", d, noise(d), terms = list(1, 2))
d <- cells(array(c(3, 5, 2, 7, 4, 6), c(2, 3))); add("additive model, unbalanced", d, noise(d), terms = list(1, 2))
d <- cells(array(c(3, 5, 2, 7, 4, 6), c(2, 3))); add("interaction alone", d, noise(d), terms = list(c(1, 2)))
d <- cells(array(c(3, 5, 2, 7, 4, 6), c(2, 3))); add("interaction and one factor", d, noise(d), terms = list(1, c(1, 2)))
d <- cells(balanced(2, 3, 2, 3)); add("three factors", d, noise(d))
d <- cells(array(sample(1:4, 12, TRUE), c(2, 3, 2))); add("three factors, unbalanced", d, noise(d))
d <- cells(array(sample(0:4, 24, TRUE), c(4, 3, 2)))
add("three factors, empty cells", d, noise(d), terms = list(1, 2, 3, c(1, 2), c(1, 3)))
d <- cells(array(c(3, 5, 2, 7, 4, 6), c(2, 3))); base <- noise(d)
add("huge scale", d, base, exponent = 498)
add("tiny scale", d, base, exponent = -498)
add("large offset", d, base, offset = 1e8)
add("large negative offset", d, base * 1e-2, offset = -2^40)
d <- cells(balanced(4, 3, 8)); add("counts", d, rpois(length(d[[1]]), 7 + 2 * d[[1]]))
d <- cells(array(c(5, 9, 7, 12, 6, 8), c(3, 2))); add("small counts with many ties", d, rpois(length(d[[1]]), 1.2))
d <- cells(array(c(8, 12, 9, 11), c(2, 2))); add("rounded values with ties", d, round(noise(d) * 2) / 2)
d <- cells(array(c(20, 30, 25, 10), c(2, 2))); add("binary values", d, rbinom(length(d[[1]]), 1, 0.4))
d <- cells(array(c(60, 80, 75, 55, 70, 90), c(3, 2))); add("a few hundred observations", d, noise(d, effect = 0.2))
d <- cells(balanced(5, 6, 3)); add("heavy tails", d, rt(length(d[[1]]), 2))
d <- cells(balanced(3, 12)); add("strong effect", d, noise(d, sd = 0.05, effect = 3))
d <- cells(array(c(10, 12, 0, 11), c(2, 2))); add("2 x 2 with an empty cell", d, noise(d))

# ---- blocks ----

blocked <- function(name, within, sizes) {
  group <- rep(seq_along(sizes), sizes)
  d <- expand.grid(within = seq_len(within), block = seq_along(group))
  d <- d[sample(nrow(d)), ]
  d$between <- group[d$block]
  d$y <- rnorm(nrow(d)) + 3 * rnorm(length(group))[d$block] + 0.5 * d$within + 0.3 * d$within * d$between
  codes <- lapply(d[c("within", "between", "block")], function(x) array_of(x - 1))
  model <- if (length(sizes) > 1) y ~ factor(within) * factor(between) + Error(factor(block)) else
    y ~ factor(within) + Error(factor(block))
  table <- summary(aov(model, data = d))[["Error: Within"]][[1]]
  rows <- lapply(seq_len(nrow(table) - 1), function(i)
    list(df = table[i, "Df"], ss = table[i, "Sum Sq"], f = table[i, "F value"], p = table[i, "Pr(>F)"]))
  list(name = name, y = array_of(d$y), within = codes$within, between = codes$between, block = codes$block,
       terms = rows, residual_ss = table[nrow(table), "Sum Sq"], residual_df = table[nrow(table), "Df"])
}
blocks <- list(blocked("three groups of six blocks", 4, c(6, 6, 6)), blocked("groups of unequal size", 3, c(2, 7, 4)),
               blocked("one group", 5, 8))

# ---- adjusted p-values, studentised range, power ----

p_lists <- list(c(0.01, 0.04, 0.03, 0.005), runif(12)^3, c(0.02, 0.02, 0.02), c(0, 1, 0.5, 1e-300), 0.3)
adjusted <- lapply(p_lists, function(p) list(p = array_of(p), bonferroni = array_of(p.adjust(p, "bonferroni")),
                                             holm = array_of(p.adjust(p, "holm"))))

ranges <- list()
for (k in c(2, 3, 4, 6, 20)) for (df in c(2, 3, 5, 11, 56, 224, 5000)) for (q in c(0.01, 0.5, 2, 3.5, 4.5, 6, 9, 14)) {
  p <- tukey_upper(q, k, df)
  if (p > 1e-6) ranges[[length(ranges) + 1]] <- list(groups = k, df = df, q = q, p = p,
                                                     ptukey = ptukey(q, k, df, lower.tail = FALSE))
}

powers <- list()
for (groups in c(2, 4, 6)) for (n in c(5, 15, 100)) for (ratio in c(0.02, 0.1, 0.3)) {
  result <- power.anova.test(groups = groups, n = n, between.var = ratio, within.var = 1, sig.level = 0.05)
  # The population's eta squared from variances that divide by the number of groups.
  between <- ratio * (groups - 1) / groups
  powers[[length(powers) + 1]] <- list(groups = groups, observations = groups * n, eta = between / (1 + between),
                                       power = result$power)
}

# ---- where R answers with NaN, Inf, or a p-value of rounding errors ----

degenerate <- list()
add_degenerate <- function(name, codes, y, terms = full_terms(length(codes))) {
  names <- letters[seq_along(codes)]
  data <- data.frame(y = y)
  for (f in seq_along(codes)) data[[names[f]]] <- factor(codes[[f]])
  labels <- vapply(terms, term_label, "", names)
  model <- aov(as.formula(paste("y ~", paste(labels, collapse = "+"))), data)
  f <- suppressWarnings(summary(model))[[1]][["F value"]]
  degenerate[[length(degenerate) + 1]] <<- list(name = name, y = array_of(y), exponent = 0, offset = 0,
                                                factors = lapply(codes, array_of),
                                                terms = lapply(terms, function(t) array_of(t - 1)),
                                                r_says = paste(format(f), collapse = " "))
}
d <- cells(balanced(3, 4)); add_degenerate("all values are equal", d, rep(0.1, 12))
add_degenerate("no spread within groups", d, c(0.1, 0.7, 1.3)[d[[1]] + 1])
add_degenerate("spread of rounding errors", d,
               c(0.1, 0.7, 1.3)[d[[1]] + 1] + rep(c(0, 1, 0, 2), 3) * 2^-53)
add_degenerate("no spread at an offset", d, 1e8 + c(1, 2, 3)[d[[1]] + 1])
add_degenerate("no spread at a huge scale", d, 1e150 * c(1, 2, 3)[d[[1]] + 1])
add_degenerate("no spread at a tiny scale", d, 1e-150 * c(1, 2, 3)[d[[1]] + 1])
d <- cells(balanced(3, 2, 1)); add_degenerate("one observation per cell, crossed", d, rnorm(6))
add_degenerate("exactly additive", d, 0.1 * d[[1]] + 0.3 * d[[2]], terms = list(1, 2))
d <- cells(array(c(3, 0, 0, 4), c(2, 2))); add_degenerate("two factors that are one", d, rnorm(7))
d <- cells(balanced(4, 1)); add_degenerate("one observation per group", d, rnorm(4))

# ---- write ----

writeLines(paste0("{\"made_by\":\"", R.version.string, "\",\n",
                  paste(lines("data_sets", data_sets), lines("blocks", blocks), lines("adjusted", adjusted),
                        lines("degenerate", degenerate), lines("studentized_range", ranges), lines("power", powers), sep = ",\n"), "\n}"),
           file.path(folder, "anova.json"))
cat(length(data_sets), "data sets\n")
