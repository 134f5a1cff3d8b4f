// Puts the audit together from the document inside the page.
import { render } from 'preact';
import { installTheme } from '../shared/theme';
import type { Audit } from './document';
import { Page } from './page';

const kSchema = 'kith.audit/1';

installTheme();
const audit = JSON.parse(document.getElementById('kith-document')?.textContent ?? '') as Audit;
if (audit.schema !== kSchema) throw new Error(`this page draws documents of schema ${kSchema}, not ${audit.schema}`);
const page = document.getElementById('page');
page?.replaceChildren();
if (page) render(<Page audit={audit} />, page);
