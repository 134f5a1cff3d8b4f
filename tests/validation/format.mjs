// How figures are printed, and the cells that carry them: {text, value, se}.

export const fixed = (value, digits) => {
  const text = value.toFixed(digits);
  return /^-0(\.0*)?$/.test(text) ? text.slice(1) : text;
};
export const signed = (value, digits) => (value >= 0 && !fixed(value, digits).startsWith('-') ? '+' : '') + fixed(value, digits);
export const grouped = (count) => String(count).replace(/\B(?=(\d{3})+$)/g, ' ');
export const percent = (share, digits = 0) => `${fixed(100 * share, digits)} %`;
export const probability = (p) => (p < 0.001 ? '< .001' : fixed(p, p < 0.1 ? 3 : 2).replace(/^0/, ''));

// "7.75 (0.02)": a figure with its Monte-Carlo standard error.
export const withError = ({ value, se }, digits, print = fixed) => ({ text: `${print(value, digits)} (${fixed(se, digits)})`, value, se });
export const figure = ({ value, se }, digits, print = fixed) => ({ text: print(value, digits), value, se });
export const interval = (low, high, digits) => `[${fixed(low, digits)}, ${fixed(high, digits)}]`;
export const withInterval = (value, low, high, digits) => ({
  text: `${fixed(value, digits)} ${interval(low, high, digits)}`,
  value,
  se: (high - low) / (2 * 1.96),
});
