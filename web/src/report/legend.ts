// The legend of strategies: as many columns as fit. It is put into the compiled specification as a
// whole (chart.ts), because Vega-Lite would merge one from every layer's marks.
import type { Spec } from './chart';
import type { Look } from './palette';

const kLetter = 6.8; // px, mean width of a letter of the legend
const kSymbol = 34; // px, symbol and gap

function columnsFor(labels: string[], width: number): number {
  const widths = labels.map((label) => label.length * kLetter + kSymbol);
  if (widths.reduce((sum, one) => sum + one, 0) <= width) return labels.length;
  const fitting = Math.max(1, Math.floor(width / Math.max(...widths)));
  return Math.ceil(labels.length / Math.ceil(labels.length / fitting));
}

// `kind` line: a piece of the line with its dash; mark: the filled shape.
export function strategyLegend(looks: Look[], width: number, kind: 'line' | 'mark'): Spec {
  const columns = columnsFor(
    looks.map((look) => look.label),
    width,
  );
  return kind === 'line'
    ? {
        columns,
        stroke: 'color',
        strokeDash: 'strokeDash',
        symbolType: 'stroke',
        symbolSize: 380,
        symbolStrokeWidth: 2.2,
      }
    : { columns, fill: 'color', shape: 'shape', symbolStrokeWidth: 0 };
}
