// Figures as files for a paper: as wide as a column or a page, with text of 7 to 8 points, in light colours.
import { View, parse } from 'vega';
import { expressionInterpreter } from 'vega-interpreter';
import { el } from '../shared/dom';
import { type Spec, toVega } from './chart';
import { inLight } from '../shared/theme';

export const kWidths = [89, 183]; // mm, of one column and of two
const kPointsPerMm = 72 / 25.4;
const kPointsPerPixel = 0.65; // text of 11 to 12 px has 7.15 to 7.8 points
const kDpi = 300;

export type Format = 'svg' | 'png';

// A view without a page.
function lightView(spec: Spec): View {
  const light = { ...inLight(toVega(spec)), background: '#ffffff' };
  return new View(parse(light, {}, { ast: true }), { renderer: 'none', expr: expressionInterpreter } as never);
}

// The time when a PNG was made is not in it, but its resolution is: a chunk behind the header.
async function withResolution(png: Blob): Promise<Blob> {
  const bytes = new Uint8Array(await png.arrayBuffer());
  const chunk = new DataView(new ArrayBuffer(21));
  const perMetre = Math.round(kDpi / 0.0254);
  chunk.setUint32(0, 9);
  [...'pHYs'].forEach((letter, i) => chunk.setUint8(4 + i, letter.charCodeAt(0)));
  chunk.setUint32(8, perMetre);
  chunk.setUint32(12, perMetre);
  chunk.setUint8(16, 1);
  let crc = 0xffffffff;
  for (let i = 4; i < 17; ++i) {
    crc ^= chunk.getUint8(i);
    for (let bit = 0; bit < 8; ++bit) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
  }
  chunk.setUint32(17, ~crc >>> 0);
  const header = 33; // signature and first chunk
  return new Blob([bytes.subarray(0, header), chunk.buffer, bytes.subarray(header)], { type: 'image/png' });
}

function svgFile(text: string, scale: number): Blob {
  const inMm = (pixels: string): string => `${Number(((Number(pixels) * scale) / kPointsPerMm).toFixed(2))}mm`;
  const sized = text.replace(
    /<svg ([^>]*?)width="([\d.]+)" height="([\d.]+)"/,
    (_, before: string, width: string, height: string) => `<svg ${before}width="${inMm(width)}" height="${inMm(height)}"`,
  );
  return new Blob([sized], { type: 'image/svg+xml' });
}

async function svgOf(spec: Spec): Promise<string> {
  const view = lightView(spec);
  const svg = await view.toSVG();
  view.finalize();
  return svg;
}

async function canvasOf(svg: string, scale: number): Promise<HTMLCanvasElement> {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`;
  await image.decode();
  const canvas = el('canvas', { width: Math.round(scale * image.width), height: Math.round(scale * image.height) });
  const to = canvas.getContext('2d');
  if (!to) throw new Error('the browser draws nothing');
  to.fillStyle = '#ffffff';
  to.fillRect(0, 0, canvas.width, canvas.height);
  to.drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas;
}

// `spec` draws the figure at a width in pixels.
export async function paperFile(spec: (width: number) => Spec | string, mm: number, format: Format): Promise<Blob> {
  const points = mm * kPointsPerMm;
  const drawn = spec(Math.floor(points / kPointsPerPixel));
  const svg = typeof drawn === 'string' ? inLight(drawn) : await svgOf(drawn);
  const width = Number(/^<svg [^>]*?width="([\d.]+)"/.exec(svg)?.[1]);
  // A figure that needs more room than it was given is made smaller.
  const scale = Math.min(kPointsPerPixel, points / width);
  if (format === 'svg') return svgFile(svg, scale);
  const canvas = await canvasOf(svg, (scale * kDpi) / 72);
  const png = await new Promise<Blob>((resolve, reject) => {
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error('the browser made no PNG'))), 'image/png');
  });
  return withResolution(png);
}
