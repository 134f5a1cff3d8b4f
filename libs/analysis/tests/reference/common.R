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

# ---- JSON: a vector is an array, unless it is marked as one value; a list is an object if it has names ----

one <- function(x) structure(list(x), class = "one")
scalars <- function(x) {
  if (is.character(x)) return(paste0('"', x, '"'))
  if (is.logical(x) && !anyNA(x)) return(ifelse(x, "true", "false"))
  ifelse(is.na(x), "null", formatC(x, digits = 17, format = "g", width = 1))
}
# A data set is one line: members of the document, and entries of their lists, begin on lines of their own.
as_json <- function(x, depth = 1) {
  if (inherits(x, "one")) return(scalars(x[[1]]))
  if (!is.list(x)) return(paste0("[", paste(scalars(x), collapse = ","), "]"))
  if (!length(x)) return("[]")
  parts <- vapply(x, as_json, "", depth = depth + 1)
  between <- if (depth <= 2) ",\n" else ","
  if (is.null(names(x))) return(paste0("[", if (depth == 2) "\n", paste(parts, collapse = between), "]"))
  paste0("{", paste0('"', names(x), '":', parts, collapse = between), "}")
}

# ---- factors ----

codes <- function(f) as.integer(f) - 1L
factor_json <- function(name, f) list(name = one(name), levels = levels(f), codes = codes(f))
factors_json <- function(fs) unname(Map(factor_json, names(fs), fs))
terms_json <- function(terms, fs) lapply(strsplit(terms, ":"), function(t) match(t, names(fs)) - 1)
drawn <- function(prefix, k, n, p = NULL)
  factor(sample(paste0(prefix, seq_len(k)), n, TRUE, p), levels = paste0(prefix, seq_len(k)))

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
