// Starts the page with the token of the link.
import { render } from 'preact';
import { App } from './app';
import { takeToken } from './session';
import { NoToken } from './welcome';

document.title = 'Facilitator - kith';
const page = document.getElementById('page');
if (page) {
  page.replaceChildren();
  const token = takeToken();
  // A link that is opened in a tab which already shows the page changes only the fragment.
  window.addEventListener('hashchange', () => {
    if (window.location.hash.startsWith('#t=')) window.location.reload();
  });
  render(token ? <App token={token} /> : <NoToken />, page);
}
