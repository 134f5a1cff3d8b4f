// A drawing context that writes PDF, as far as Vega's canvas renderer needs one: paths, fills, strokes, clips and text
// in Helvetica, which every reader of PDF has.

interface State {
  fill: string;
  stroke: string;
  alpha: number;
  size: number;
  bold: boolean;
  align: string;
}

const kByName: Record<string, number> = { '\u2013': 0x96, '\u2014': 0x97, '\u2018': 0x91, '\u2019': 0x92, '\u2212': 0x96, '\u2022': 0x95 };
const kArc = (4 / 3) * (Math.SQRT2 - 1);
const number = (value: number): string => String(Number(value.toFixed(3)));

// WinAnsiEncoding in hexadecimal; what it has not becomes a question mark.
function encoded(text: string): string {
  return [...text]
    .map((letter) => {
      const code = kByName[letter] ?? letter.charCodeAt(0);
      return (code < 256 ? code : 0x3f).toString(16).padStart(2, '0');
    })
    .join('');
}

export class PdfContext {
  private readonly ops: string[] = [];
  private readonly states: State[] = [];
  private readonly alphas: number[] = [];
  private readonly probe = document.createElement('canvas').getContext('2d');
  private state: State = { fill: '#000000', stroke: '#000000', alpha: 1, size: 11, bold: false, align: 'left' };
  private path: string[] = [];
  private dash = '[] 0 d';

  // Set by the renderer as plain properties.
  lineWidth = 1;
  lineCap = 'butt';
  lineJoin = 'miter';
  miterLimit = 10;
  lineDashOffset = 0;
  textBaseline = 'alphabetic';
  globalCompositeOperation = 'source-over';

  set fillStyle(style: string) {
    this.state.fill = style;
  }
  set strokeStyle(style: string) {
    this.state.stroke = style;
  }
  set globalAlpha(alpha: number) {
    this.state.alpha = alpha;
  }
  get globalAlpha(): number {
    return this.state.alpha;
  }
  set textAlign(align: string) {
    this.state.align = align;
  }
  set font(font: string) {
    this.state.size = Number(/([\d.]+)px/.exec(font)?.[1] ?? 11);
    this.state.bold = /\b(bold|[6-9]00)\b/.test(font);
    if (this.probe) this.probe.font = font;
  }

  save(): void {
    this.states.push({ ...this.state });
    this.ops.push('q');
  }
  restore(): void {
    this.state = this.states.pop() ?? this.state;
    this.ops.push('Q');
  }
  transform(a: number, b: number, c: number, d: number, e: number, f: number): void {
    this.ops.push(`${[a, b, c, d, e, f].map(number).join(' ')} cm`);
  }
  translate(x: number, y: number): void {
    this.transform(1, 0, 0, 1, x, y);
  }
  scale(x: number, y: number): void {
    this.transform(x, 0, 0, y, 0, 0);
  }
  rotate(angle: number): void {
    this.transform(Math.cos(angle), Math.sin(angle), -Math.sin(angle), Math.cos(angle), 0, 0);
  }

  beginPath(): void {
    this.path = [];
  }
  closePath(): void {
    this.path.push('h');
  }
  private at: [number, number] = [0, 0];
  moveTo(x: number, y: number): void {
    this.at = [x, y];
    this.path.push(`${number(x)} ${number(y)} m`);
  }
  lineTo(x: number, y: number): void {
    if (this.path.length === 0) return this.moveTo(x, y);
    this.at = [x, y];
    this.path.push(`${number(x)} ${number(y)} l`);
  }
  bezierCurveTo(...points: [number, number, number, number, number, number]): void {
    this.at = [points[4], points[5]];
    this.path.push(`${points.map(number).join(' ')} c`);
  }
  quadraticCurveTo(cx: number, cy: number, x: number, y: number): void {
    const [px, py] = this.at;
    this.bezierCurveTo(px + (2 / 3) * (cx - px), py + (2 / 3) * (cy - py), x + (2 / 3) * (cx - x), y + (2 / 3) * (cy - y), x, y);
  }
  rect(x: number, y: number, width: number, height: number): void {
    this.path.push(`${[x, y, width, height].map(number).join(' ')} re`);
  }
  arc(x: number, y: number, radius: number, from: number, to: number, isBackward = false): void {
    let sweep = to - from;
    if (isBackward && sweep > 0) sweep -= 2 * Math.PI;
    if (!isBackward && sweep < 0) sweep += 2 * Math.PI;
    const pieces = Math.max(1, Math.ceil(Math.abs(sweep) / (Math.PI / 2) - 1e-9));
    const step = sweep / pieces;
    const pull = kArc * Math.tan(step / 4) / Math.tan(Math.PI / 8);
    this.lineTo(x + radius * Math.cos(from), y + radius * Math.sin(from));
    for (let i = 0; i < pieces; ++i) {
      const [a, b] = [from + i * step, from + (i + 1) * step];
      this.bezierCurveTo(
        x + radius * (Math.cos(a) - pull * Math.sin(a)),
        y + radius * (Math.sin(a) + pull * Math.cos(a)),
        x + radius * (Math.cos(b) + pull * Math.sin(b)),
        y + radius * (Math.sin(b) - pull * Math.cos(b)),
        x + radius * Math.cos(b),
        y + radius * Math.sin(b),
      );
    }
  }

  clip(): void {
    this.ops.push(...this.path, 'W n');
  }
  fill(): void {
    const color = this.color(this.state.fill);
    if (color) this.ops.push('q', this.opacity(color.alpha), `${color.rgb} rg`, ...this.path, 'f', 'Q');
  }
  stroke(): void {
    const color = this.color(this.state.stroke);
    if (!color) return;
    const cap = ['butt', 'round', 'square'].indexOf(this.lineCap);
    const join = ['miter', 'round', 'bevel'].indexOf(this.lineJoin);
    const style = [`${number(this.lineWidth)} w`, `${Math.max(0, cap)} J`, `${Math.max(0, join)} j`, this.dash];
    this.ops.push('q', this.opacity(color.alpha), `${color.rgb} RG`, ...style, ...this.path, 'S', 'Q');
  }
  fillRect(x: number, y: number, width: number, height: number): void {
    this.beginPath();
    this.rect(x, y, width, height);
    this.fill();
  }
  clearRect(): void {} // paper is white
  setLineDash(dash: number[]): void {
    this.dash = `[${dash.map(number).join(' ')}] ${number(this.lineDashOffset)} d`;
  }

  measureText(text: string): { width: number } {
    return { width: this.probe?.measureText(text).width ?? text.length * this.state.size * 0.5 };
  }
  fillText(text: string, x: number, y: number): void {
    this.write(text, x, y, 0, this.state.fill);
  }
  strokeText(text: string, x: number, y: number): void {
    this.write(text, x, y, 1, this.state.stroke);
  }
  private write(text: string, x: number, y: number, mode: number, style: string): void {
    const color = this.color(style);
    if (!color) return;
    const width = this.measureText(text).width;
    const left = this.state.align === 'center' ? x - width / 2 : /right|end/.test(this.state.align) ? x - width : x;
    const { size, bold } = this.state;
    const paint = mode === 0 ? 'rg' : 'RG';
    this.ops.push('q', this.opacity(color.alpha), `${color.rgb} ${paint}`, `${number(this.lineWidth)} w`);
    this.ops.push(`BT /${bold ? 'B' : 'R'} ${number(size)} Tf ${mode} Tr 1 0 0 -1 ${number(left)} ${number(y)} Tm`);
    this.ops.push(`<${encoded(text)}> Tj ET`, 'Q');
  }

  // The components of a CSS colour; null for one that paints nothing.
  private color(style: string): { rgb: string; alpha: number } | null {
    if (!this.probe || !style || style === 'transparent' || style === 'none') return null;
    this.probe.fillStyle = '#000000';
    this.probe.fillStyle = style;
    const text = String(this.probe.fillStyle);
    const parts = text.startsWith('#')
      ? [1, 3, 5].map((at) => parseInt(text.slice(at, at + 2), 16))
      : (text.match(/[\d.]+/g) ?? []).map(Number);
    const alpha = (parts[3] ?? 1) * this.state.alpha;
    if (alpha <= 0) return null;
    return { rgb: parts.slice(0, 3).map((part) => number(part / 255)).join(' '), alpha };
  }
  private opacity(alpha: number): string {
    let at = this.alphas.indexOf(alpha);
    if (at < 0) at = this.alphas.push(alpha) - 1;
    return `/A${at} gs`;
  }

  // The file: one page of this size in points, onto which the drawing's pixels are scaled.
  file(width: number, height: number, scale: number): Blob {
    const flip = `${number(scale)} 0 0 ${number(-scale)} 0 ${number(height)} cm`;
    const content = [flip, ...this.ops].join('\n');
    const states = this.alphas.map((alpha, i) => `/A${i} << /ca ${number(alpha)} /CA ${number(alpha)} >>`).join(' ');
    const font = (name: string): string => `<< /Type /Font /Subtype /Type1 /BaseFont /${name} /Encoding /WinAnsiEncoding >>`;
    const objects = [
      '<< /Type /Catalog /Pages 2 0 R >>',
      '<< /Type /Pages /Kids [3 0 R] /Count 1 >>',
      `<< /Type /Page /Parent 2 0 R /MediaBox [0 0 ${number(width)} ${number(height)}] /Contents 4 0 R /Resources << /Font << /R 5 0 R /B 6 0 R >> /ExtGState << ${states} >> >> >>`,
      `<< /Length ${content.length} >>\nstream\n${content}\nendstream`,
      font('Helvetica'),
      font('Helvetica-Bold'),
    ];
    let text = '%PDF-1.4\n';
    const places = objects.map((object, i) => {
      const at = text.length;
      text += `${i + 1} 0 obj\n${object}\nendobj\n`;
      return at;
    });
    const start = text.length;
    const entries = places.map((at) => `${String(at).padStart(10, '0')} 00000 n \n`).join('');
    text += `xref\n0 ${objects.length + 1}\n0000000000 65535 f \n${entries}`;
    text += `trailer\n<< /Size ${objects.length + 1} /Root 1 0 R >>\nstartxref\n${start}\n%%EOF\n`;
    return new Blob([text], { type: 'application/pdf' });
  }
}
