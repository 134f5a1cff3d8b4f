// The title of the window: the heading of the screen and the study's title. A mark says that something has begun
// while nobody looked.
let study = '';
let title = '';

function show(): void {
  document.title = document.hidden && study !== '' ? `(!) ${title}` : title;
}

export function setStudyTitle(text: string): void {
  study = text;
}

export function setHeading(heading: string): void {
  title = [heading, study].filter((text) => text !== '').join(' - ');
  show();
}

document.addEventListener('visibilitychange', () => {
  if (!document.hidden && title !== '') show();
});
