// Starts the page, which is packed into the file.
import english from '../shared/texts/en.json';
import { scriptIn } from './packed';

// English, since what is said in other languages is packed, too.
function say(title: string, text: string): void {
  const main = document.createElement('main');
  main.id = 'main';
  for (const [tag, content] of [['h1', title], ['p', text]] as const) {
    main.appendChild(document.createElement(tag)).textContent = content;
  }
  document.getElementById('page')?.replaceChildren(main);
}

if (typeof WebAssembly === 'undefined' || !('Tag' in WebAssembly)) {
  say(english['trouble.title'], english['file.old_browser']);
} else {
  try {
    const script = document.createElement('script');
    script.src = scriptIn('kith-page');
    document.head.append(script);
  } catch {
    say(english['trouble.title'], english['file.broken']);
  }
}
