# Writes means.json, the reference values of marginal_means_test.
#
#   Rscript libs/analysis/tests/reference/make_reference_means.R libs/analysis/tests/reference/means.json
#
# Needs R >= 4.2 with emmeans. Data sets are drawn here with a fixed seed and stored with the results, so that neither
# the build nor the tests need R.
#
# Tukey's p-values are stored twice: as emmeans has them, by ptukey, which is off by up to two percent for few degrees
# of freedom, and as the integral that defines them.

suppressPackageStartupMessages({ library(emmeans) })
set.seed(20261122, kind = "Mersenne-Twister", normal.kind = "Inversion", sample.kind = "Rejection")
emm_options(msg.interaction = FALSE, msg.nesting = FALSE)

folder <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
source(file.path(folder, "common.R"))

# ---- marginal means and contrasts ----

rows_of <- function(summary, sign = 1) lapply(seq_len(nrow(summary)), function(i) {
  row <- summary[i, ]
  low <- row[[grep("lower.CL|asymp.LCL", names(row))]]
  high <- row[[grep("upper.CL|asymp.UCL", names(row))]]
  list(estimate = sign * row$estimate, se = row$SE, df = row$df, low = if (sign > 0) low else -high,
       high = if (sign > 0) high else -low, p = row$p.value)
})

# In order of the groups (first `by` factor slowest) and then of the means (first factor slowest).
means_of <- function(emm, names) {
  s <- as.data.frame(summary(emm, infer = c(TRUE, TRUE), level = 0.9))
  s <- s[do.call(order, unname(lapply(names, function(n) as.integer(s[[n]])))), ]
  names(s)[names(s) %in% c("emmean", "rate", "prob")] <- "estimate"
  rows_of(s)
}

analyse <- function(model, data, over, by, weight_lists = list()) {
  emm <- emmeans(model, over, by = if (length(by)) by, data = data)
  result <- list(over = over, by = by, means = means_of(emm, c(by, over)))
  # Groups one by one, means in our order.
  groups <- if (length(by)) do.call(expand.grid, rev(lapply(data[by], levels))) else NULL
  num_groups <- if (length(by)) nrow(groups) else 1
  result$groups <- lapply(seq_len(num_groups), function(g) {
    at <- if (length(by)) lapply(groups[g, rev(by), drop = FALSE], as.character) else list()
    part <- emmeans(model, rev(over), by = if (length(by)) by, at = at, data = data)
    one <- list()
    for (adjust in c("none", "bonferroni", "holm", "fdr", "tukey")) {
      pairs <- as.data.frame(summary(contrast(part, "pairwise"), infer = c(TRUE, TRUE), adjust = adjust, level = 0.9))
      one[[adjust]] <- rows_of(pairs, -1)
    }
    k <- nrow(as.data.frame(part))
    estimable <- sum(!is.na(summary(part)[[grep("emmean|rate|prob", names(summary(part)))]]))
    one$tukey_integral <- lapply(one$none, function(row) {
      if (is.na(row$estimate) || is.na(row$se) || estimable < 3) return(NULL)
      tukey_upper(sqrt(2) * abs(row$estimate / row$se), estimable, row$df)
    })
    one$custom <- lapply(weight_lists, function(w) {
      c(list(weights = array_of(w)), rows_of(as.data.frame(summary(contrast(part, list(w)), infer = c(TRUE, TRUE))))[[1]])
    })
    one
  })
  result
}

cells <- function(counts) {
  index <- arrayInd(rep(seq_along(counts), counts), dim(counts))
  lapply(seq_along(dim(counts)), function(f) index[, f])
}
balanced <- function(...) array(list(...)[[length(list(...))]], unlist(list(...)[-length(list(...))]))
noise <- function(codes, sd = 1, effect = 0.7) {
  y <- rnorm(length(codes[[1]]), 0, sd)
  for (f in seq_along(codes)) y <- y + effect * rnorm(max(codes[[f]]))[codes[[f]]]
  y
}

data_sets <- list()
add <- function(name, counts, formula, requests, y = NULL, family = NULL) {
  codes <- cells(counts)
  data <- as.data.frame(lapply(codes, function(x) factor(letters[x], levels = letters[seq_len(max(x))])))
  names(data) <- c("a", "b", "c", "d")[seq_along(codes)]
  data$y <- if (is.null(y)) noise(codes) else if (is.function(y)) y(codes) else y
  if (!is.null(family) || !are_crossed(codes)) return(invisible())  # drawn all the same, so that what follows stays
  model <- lm(formula, data)
  labels <- attr(terms(formula), "term.labels")
  terms <- lapply(strsplit(labels, ":"), function(x) array_of(match(x, names(data)) - 1))
  entry <- list(name = name, y = array_of(data$y),
                factors = lapply(codes, function(x) array_of(x - 1)), terms = terms,
                df = df.residual(model), sigma = sigma(model),
                requests = lapply(requests, function(r) {
                  result <- do.call(analyse, c(list(model, data), r))
                  result$over <- array_of(match(r$over, names(data)) - 1)
                  result$by <- array_of(match(r$by, names(data)) - 1)
                  result
                }))
  data_sets[[length(data_sets) + 1]] <<- entry
}
over <- function(over, by = character(0), ...) list(over = over, by = by, ...)

add("one-way, unbalanced", array(c(3, 9, 2, 14), 4), y ~ a, list(over("a", weight_lists = list(c(3, -1, -1, -1), c(-3, -1, 1, 3), c(0.5, 0.5, 0, -1)))))
add("one-way, two levels", array(c(5, 8), 2), y ~ a, list(over("a")))
add("2 x 3 unbalanced, crossed", array(c(3, 5, 2, 7, 4, 6), c(2, 3)), y ~ a * b,
    list(over("a"), over("b"), over("b", "a"), over(c("a", "b"))))
add("2 x 3 unbalanced, additive", array(c(3, 5, 2, 7, 4, 6), c(2, 3)), y ~ a + b,
    list(over("a"), over("b")))
add("strongly confounded", array(c(20, 2, 1, 3, 22, 2, 2, 1, 24), c(3, 3)), y ~ a + b, list(over("a"), over("b")),
    y = function(d) 0.2 * d[[2]] + rnorm(length(d[[1]]), sd = 0.3))
add("confounded, two empty cells, additive", array(c(20, 0, 1, 3, 22, 0, 2, 1, 24), c(3, 3)), y ~ a + b, list(over("a"), over("b")))
add("3 x 3 very unbalanced", array(c(1, 9, 2, 30, 3, 1, 5, 5, 12), c(3, 3)), y ~ a * b, list(over("a"), over("b", "a")))
add("2 x 3 with an empty cell", array(c(4, 3, 0, 5, 2, 6), c(2, 3)), y ~ a * b,
    list(over("a"), over("b"), over("b", "a"), over("a", "b")))
add("4 x 3 with two empty cells", array(c(3, 4, 2, 3, 0, 5, 2, 6, 4, 0, 3, 3), c(4, 3)), y ~ a * b,
    list(over("a"), over("b"), over("a", "b", weight_lists = list(c(1, 0, -1, 0), c(1, 1, -2, 0)))))
add("3 x 3 with three empty cells, additive", array(c(5, 0, 4, 0, 3, 6, 4, 2, 0), c(3, 3)), y ~ a + b, list(over("a"), over("b")))
add("one observation per cell, additive", balanced(3, 4, 1), y ~ a + b, list(over("a"), over("b")))
add("one observation in some cells", array(c(1, 1, 2, 1, 1, 1), c(3, 2)), y ~ a * b, list(over("a"), over("b")))
add("the published design", balanced(4, 4, 15), y ~ a * b, list(over("a"), over("a", "b", weight_lists = list(c(1, 1, -1, -1), c(-3, 1, 1, 1)))))
add("three factors", balanced(2, 3, 2, 3), y ~ a * b * c, list(over("a"), over("b", "c")))
add("three factors, unbalanced", array(sample(1:4, 12, TRUE), c(2, 3, 2)), y ~ a * b * c,
    list(over("b"), over("a", c("b", "c"))))
add("three factors, two-way interactions", array(sample(0:4, 24, TRUE), c(4, 3, 2)), y ~ a + b + c + a:b + a:c,
    list(over("a"), over("b"), over("c", "a")))
add("three factors, additive, a table of observational data", array(rpois(24, 6), c(4, 3, 2)), y ~ a + b + c,
    list(over("a"), over("b"), over("c")))
add("interaction and one factor", array(c(3, 5, 2, 7, 4, 6), c(2, 3)), y ~ a + a:b, list(over("b", "a"), over("a")))
add("large offset", array(c(3, 5, 2, 7, 4, 6), c(2, 3)), y ~ a * b, list(over("a"), over("b")), y = function(d) 1e5 + noise(d))
add("small numbers", array(c(3, 5, 2, 7, 4, 6), c(2, 3)), y ~ a + b, list(over("a"), over("b")), y = function(d) 1e-6 * noise(d))
add("strong effect", balanced(3, 12), y ~ a, list(over("a")), y = function(d) 3 * d[[1]] + rnorm(36, sd = 0.3))
add("six levels, two degrees of freedom", array(c(2, 1, 1, 2, 1, 1), 6), y ~ a, list(over("a")))
add("counts, log link", array(c(10, 15, 8, 12, 20, 9), c(2, 3)), y ~ a * b, list(over("a"), over("b"), over("b", "a")),
    y = function(d) rpois(length(d[[1]]), 5 + 2 * d[[1]] + d[[2]]), family = poisson())
add("counts, additive", array(c(10, 15, 8, 12, 20, 9), c(3, 2)), y ~ a + b, list(over("a"), over("b")),
    y = function(d) rpois(length(d[[1]]), 1 + 2 * d[[1]]), family = poisson())
add("yes and no, logit link", array(c(30, 25, 28, 32, 20, 29), c(3, 2)), y ~ a + b, list(over("a"), over("b")),
    y = function(d) rbinom(length(d[[1]]), 1, 0.2 + 0.15 * d[[1]]), family = binomial())

# ---- write ----

made_by <- paste0(R.version.string, ", emmeans ", packageVersion("emmeans"))
writeLines(paste0("{\"made_by\":\"", made_by, "\",\n", paste(lines("data_sets", data_sets), sep = ",\n"), "\n}"),
           commandArgs(TRUE)[1])
cat(length(data_sets), "data sets\n")
