// Paper cannot open boxes: the tests behind the findings and the BibTeX are opened for printing.
const kOnPaper = '.finding details, #methods details, #reproduce details';

export function openForPrinting(): void {
  let opened: HTMLDetailsElement[] = [];
  window.addEventListener('beforeprint', () => {
    opened = [...document.querySelectorAll<HTMLDetailsElement>(kOnPaper)].filter((box) => !box.open);
    for (const box of opened) box.open = true;
  });
  window.addEventListener('afterprint', () => {
    for (const box of opened) box.open = false;
  });
}
