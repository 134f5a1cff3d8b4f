# What the scripts make_reference*.R of this folder share: JSON with all digits, random factors, and tails of the
# studentised range. They source it from their own folder.

# ---- JSON: vectors of length one are values ----

number <- function(x) ifelse(is.finite(x), sprintf("%.17g", x), "null")
json <- function(x) {
  if (is.null(x)) return("null")
  if (is.list(x)) {
    items <- vapply(x, json, "")
    if (is.null(names(x))) return(paste0("[", paste(items, collapse = ","), "]"))
    return(paste0("{", paste0("\"", names(x), "\":", items, collapse = ","), "}"))
  }
  if (is.character(x)) return(paste0("\"", x, "\""))
  if (is.logical(x) && !is.na(x)) return(ifelse(x, "true", "false"))
  number(x)
}
array_of <- function(x) unname(as.list(x))
lines <- function(name, entries) paste0("\"", name, "\":[\n", paste(vapply(entries, json, ""), collapse = ",\n"), "\n]")

# ---- factors ----

# Whether every combination of levels has observations, in numbers proportional to those of its levels.
are_crossed <- function(codes) {
  counts <- table(codes)
  expected <- Reduce(outer, lapply(seq_along(codes), function(f) apply(counts, f, sum) / sum(counts))) * sum(counts)
  all(abs(counts - expected) < 1e-9)
}

# ---- studentised range, by its definition ----

range_upper <- function(r, k) vapply(r, function(r) {
  f <- function(z) k * dnorm(z) * pnorm(z)^(k - 1) * -expm1((k - 1) * log1p(-pnorm(z - r) / pnorm(z)))
  integrate(f, r / 2 - 9, max(r / 2 + 9, 9.5), rel.tol = 1e-12, subdivisions = 2000)$value
}, 0)
tukey_upper <- function(q, k, df) {
  if (q == 0) return(1)
  if (is.infinite(df)) return(range_upper(q, k))
  density <- function(s) exp(log(2) + df / 2 * log(df / 2) - lgamma(df / 2) + (df - 1) * log(s) - df * s^2 / 2)
  f <- function(s) density(s) * range_upper(q * s, k)
  middle <- sqrt(df / (df + q^2 / 2))
  sd <- 1 / sqrt(2 * df)
  integrate(f, max(0, middle - 12 * sd), middle, rel.tol = 1e-11, subdivisions = 4000)$value +
    integrate(f, middle, 1 + 12 * sd, rel.tol = 1e-11, subdivisions = 4000)$value
}
