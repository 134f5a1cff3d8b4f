// Puts the lesson together from the document inside the page.
import { render } from 'preact';
import { el } from '../shared/dom';
import { installTheme } from '../shared/theme';
import { readLesson } from './document';
import { Page } from './page';

installTheme();
// The domain's own title may tell what is to be found out.
document.title = 'What will the robot do?';
const page = document.getElementById('page');
if (page) {
  try {
    const lesson = readLesson();
    page.replaceChildren();
    render(<Page lesson={lesson} />, page);
  } catch (error) {
    page.replaceChildren(
      el('main', { id: 'main' }, el('h1', {}, 'This lesson cannot be shown'), el('p', {}, String(error))),
    );
    throw error;
  }
}
