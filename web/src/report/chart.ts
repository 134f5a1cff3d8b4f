// Drawing a specification. Expressions run through the interpreter (`ast`), because
// the page's policy forbids making code from strings.
import embed, { type Result } from 'vega-embed';
import type { Spec as VegaSpec, View } from 'vega';
import { type TopLevelSpec, compile } from 'vega-lite';
import { color } from '../shared/theme';

// Specifications are data; the libraries check them.
export type Json = string | number | boolean | null | undefined | Json[] | { [key: string]: Json };
export type Spec = { [key: string]: Json };

const kFont = '"Helvetica Neue", Helvetica, Arial, "Liberation Sans", sans-serif';

const kText = {
  labelFont: kFont,
  titleFont: kFont,
  labelColor: color('muted'),
  titleColor: color('text'),
  labelFontSize: 11,
  titleFontSize: 12,
  titleFontWeight: 'normal',
};

const kConfig = {
  background: null,
  font: kFont,
  aria: false, // the figure has one text alternative; thousands of labelled points would drown it
  padding: 4,
  view: { stroke: null },
  axis: {
    ...kText,
    gridColor: color('grid'),
    domainColor: color('line'),
    tickColor: color('line'),
    titlePadding: 8,
    labelOverlap: true,
  },
  legend: {
    ...kText,
    orient: 'top',
    title: null,
    symbolSize: 90,
    columnPadding: 14,
    labelFontSize: 12,
    labelColor: color('text'),
  },
  title: {
    font: kFont,
    color: color('text'),
    fontSize: 12,
    fontWeight: 600,
    anchor: 'start',
    frame: 'group',
    offset: 8,
  },
  text: { font: kFont, fill: color('text') },
};

// Compiles Vega-Lite; `usermeta.legend` of a figure is the one legend of its strategies.
export function toVega(spec: Spec): VegaSpec {
  const { usermeta, ...rest } = spec;
  const vega = compile(rest as unknown as TopLevelSpec, { config: kConfig as never }).spec;
  const legend = usermeta as { legend?: Spec } | undefined;
  return legend?.legend ? { ...vega, legends: [legend.legend as never] } : vega;
}

export interface Drawing {
  view: View;
  finish(): void;
}

export async function draw(box: HTMLElement, spec: Spec): Promise<Drawing> {
  const result: Result = await embed(box, toVega(spec), {
    mode: 'vega',
    actions: false,
    ast: true,
    renderer: 'svg',
    tooltip: { theme: 'kith', disableDefaultStyle: true },
    defaultStyle: false,
  });
  return { view: result.view, finish: () => result.finalize() };
}
