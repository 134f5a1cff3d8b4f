# What make_reference_mixed.R and make_reference_designs.R share: lmer's fit, carried on to the minimum of its deviance.
# They source it from their own folder, after lme4 and numDeriv.
#
# lme4's optimisers stop at about 1e-5 of theta; here Newton's method goes on from there, with lme4's own deviance.

# theta below this is 0.
kSingular <- 1e-4

polished <- function(devfun, theta) {
  theta[theta < kSingular] <- 0
  free <- theta > 0
  if (any(free)) {
    f <- function(x) { full <- theta; full[free] <- x; devfun(full) }
    x <- theta[free]
    for (i in 1:8) {
      step <- solve(hessian(f, x), grad(f, x, method.args = list(r = 6)))
      x <- x - step
      if (max(abs(step / x)) < 1e-10) break
    }
    theta[free] <- x
  }
  theta
}

fit <- function(formula, d, reml) {
  control <- lmerControl(check.conv.singular = "ignore", check.conv.grad = "ignore", check.conv.hess = "ignore",
                         check.rankX = "silent.drop.cols")
  parts <- lFormula(formula, d, REML = reml, control = control)
  devfun <- do.call(mkLmerDevfun, parts)
  start <- optimizeLmer(devfun, control = list(xtol_abs = 1e-10, ftol_abs = 1e-12))
  theta <- polished(devfun, start$par)
  value <- devfun(theta)
  model <- mkMerMod(environment(devfun), list(par = theta, fval = value, conv = 0, feval = 0), parts$reTrms,
                    fr = parts$fr, mc = call("lmer", formula = formula))
  list(model = as(model, "lmerMod"), devfun = devfun, theta = theta, value = value)
}
