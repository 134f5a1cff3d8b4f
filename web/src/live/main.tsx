// The page of somebody who takes part.
import { render } from 'preact';
import { App } from './app';
import { loadTexts, t } from '../shared/texts';

const kPatience = 800; // milliseconds that the first screen waits for its language
const page = document.getElementById('page');

function show(): void {
  if (!page) return;
  const skip = document.querySelector('.skip');
  if (skip) skip.textContent = t('page.skip');
  render(<App />, page);
}

const loaded = loadTexts();
void Promise.race([loaded, new Promise((resolve) => setTimeout(resolve, kPatience))]).then(() => {
  page?.replaceChildren();
  show();
  void loaded.then(show);
});
