# compare.R KITH R: compares the tables of two folders: those that kith wrote, with their list tables.csv, and those of R,
# each with its caption in its first column. Rows are matched by their texts, numbers by the names of their columns.
arguments <- commandArgs(trailingOnly = TRUE)
known <- read.csv(file.path(arguments[1], "tables.csv"))
tolerance <- 1e-4
compared <- 0
largest <- 0
failures <- character()
for (file in list.files(arguments[2], pattern = "[.]csv$", full.names = TRUE)) {
  theirs <- read.csv(file, check.names = FALSE)
  caption <- theirs$caption[1]
  entry <- known$file[known$caption == caption]
  if (length(entry) != 1) {
    failures <- c(failures, paste0("kith has no table '", caption, "'"))
    next
  }
  ours <- read.csv(file.path(arguments[1], entry), check.names = FALSE)
  columns <- intersect(names(ours), names(theirs))
  numeric <- columns[sapply(columns, function(column) is.numeric(ours[[column]]) && is.numeric(theirs[[column]]))]
  texts <- setdiff(columns, numeric)
  key <- function(table) gsub("[()`]", "", do.call(paste, c(lapply(texts, function(column) table[[column]]), sep = "|")))
  matched <- match(key(theirs), key(ours))
  if (anyNA(matched)) {
    failures <- c(failures, paste0(caption, ": no row ", key(theirs)[is.na(matched)][1]))
    next
  }
  for (column in numeric) {
    a <- ours[[column]][matched]
    b <- theirs[[column]]
    known_by_both <- !is.na(a) & !is.na(b)
    difference <- abs(a - b) / pmax(abs(b), 1e-3)
    wrong <- known_by_both & difference > tolerance
    compared <- compared + sum(known_by_both)
    largest <- max(largest, difference[known_by_both])
    if (any(wrong)) {
      failures <- c(failures, sprintf("%s, %s: %s is %.8g in kith and %.8g in R", caption, key(theirs)[wrong][1],
                                      column, a[wrong][1], b[wrong][1]))
    }
  }
}
cat(compared, "numbers compared, largest relative difference", format(largest, digits = 2), "\n")
if (compared < 5) failures <- c(failures, "hardly anything was compared")
if (length(failures) > 0) {
  cat(failures, sep = "\n")
  quit(status = 1)
}
